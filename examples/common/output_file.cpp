// SPDX-License-Identifier: MIT
#include "output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <new>
#include <random>
#include <stdexcept>
#include <system_error>

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& file, const std::string& reason) {
  throw std::runtime_error(file + ": " + reason);
}

[[noreturn]] void throw_error(int reason) {
  throw std::runtime_error(std::generic_category().message(reason));
}

std::string last_error() { return std::generic_category().message(errno); }

/// What a chain of links names at last, whether it exists or not.
fs::path followed(fs::path file) {
  constexpr int longest = 40;  // as of Linux: a ring has no end
  std::error_code error;
  for (int link = 0; link < longest && fs::is_symlink(file, error); ++link) {
    const fs::path named = fs::read_symlink(file, error);
    if (error) break;
    file = file.parent_path() / named;
  }
  return file;
}

/// Where and how a file is written.
struct Target {
  explicit Target(const std::string& file) : path(followed(file)) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    exists = fs::exists(status);
    device = exists && !fs::is_regular_file(status);
    permissions = status.permissions();
    if (fs::is_directory(status)) fail(file, "is a folder");
    if (exists && access(path.c_str(), W_OK) != 0) fail(file, last_error());
  }

  fs::path path;
  bool exists = false;
  bool device = false;
  fs::perms permissions = fs::perms::unknown;
};

/// A new file beside the target, removed again unless it has taken its place.
class Unfinished {
 public:
  Unfinished(const std::string& file, const Target& target) {
    std::random_device random;
    constexpr int attempts = 100;
    int made = -1;
    errno = EEXIST;
    for (int i = 0; i < attempts && made < 0 && errno == EEXIST; ++i) {
      path_ = target.path.parent_path() /
              (".freqsynth-" + std::to_string(random()) + target.path.extension().string());
      made = open(path_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    }
    if (made < 0) {
      path_.clear();
      fail(file, last_error());
    }
    close(made);
    std::error_code ignored;
    if (target.exists) fs::permissions(path_, target.permissions, ignored);
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  ~Unfinished() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove(path_, ignored);
  }

  [[nodiscard]] std::string name() const { return path_.string(); }

  /// Some disks tell only here that they are full.
  void reach_disk() const {
    const int file = open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    const bool failed = file < 0 || (fsync(file) != 0 && errno != EINVAL);
    const int reason = errno;
    if (file >= 0) close(file);
    if (failed) throw_error(reason);
  }

  void take_place_of(const fs::path& target) {
    fs::rename(path_, target);
    path_.clear();
  }

 private:
  fs::path path_;
};

/// Runs `work`, whose errors then name the file.
void naming(const std::string& file, const std::function<void()>& work) {
  try {
    work();
  } catch (const std::bad_alloc&) {
    throw;  // says nothing of the file
  } catch (const std::exception& reason) {
    const std::string what = reason.what();
    if (what.starts_with(file + ": ")) throw;
    fail(file, what);
  }
}

}  // namespace

void write_whole(const std::string& file, const std::function<void(const std::string&)>& write) {
  const Target target(file);
  naming(file, [&] {
    if (target.device) return write(file);
    Unfinished unfinished(file, target);
    write(unfinished.name());
    unfinished.reach_disk();
    unfinished.take_place_of(target.path);
  });
}

void check_writable(const std::string& file, const std::function<void(const std::string&)>& trial) {
  const Target target(file);
  if (target.device) return;
  naming(file, [&] {
    const Unfinished unfinished(file, target);
    if (trial) trial(unfinished.name());
  });
}

void write_bytes(const std::string& name, std::string_view bytes) {
  const int file = open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) throw_error(errno);
  int reason = 0;
  while (!bytes.empty() && reason == 0) {
    const ssize_t written = write(file, bytes.data(), bytes.size());
    if (written >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      reason = errno;
    }
  }
  if (close(file) != 0 && reason == 0) reason = errno;
  if (reason != 0) throw_error(reason);
}

void make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) {
    fail(folder, error ? error.message() : "not a folder");
  }
}
