// SPDX-License-Identifier: MIT
#include "window_state.h"

#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "bytes.h"
#include "common/output_file.h"

namespace farm {
namespace {

constexpr std::string_view mark = "freqsynth windows 1\n";

template <class T>
void put_all(std::vector<std::byte>& bytes, std::span<const T> values) {
  const auto raw = std::as_bytes(values);
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

/// \return whether there were enough bytes
template <class T>
bool take_all(std::span<const std::byte>& bytes, std::span<T> values) {
  if (bytes.size() < values.size_bytes()) return false;
  std::memcpy(values.data(), bytes.data(), values.size_bytes());
  bytes = bytes.subspan(values.size_bytes());
  return true;
}

/// What tells a state from others.
std::string head_of(const std::string& what, const Picture& picture) {
  return std::string(mark) + what + ' ' + std::to_string(picture.channels) + '\n';
}

std::vector<std::byte> read_bytes(const std::string& file) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  if (!stream) throw std::runtime_error(file + ": cannot be read");
  const std::streamoff size = stream.tellg();
  if (size < 0) throw std::runtime_error(file + ": cannot be read");
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  stream.seekg(0);
  stream.read(reinterpret_cast<char*>(bytes.data()), size);
  if (!stream) throw std::runtime_error(file + ": cannot be read");
  return bytes;
}

/// The rest of a file behind its head. \return whether it is all there, and nothing else
bool take_state(std::span<const std::byte> bytes, WindowState& state) {
  std::uint64_t count = 0;
  if (!take_all(bytes, std::span(&count, 1)) || count > bytes.size() / sizeof(WindowTask)) {
    return false;
  }
  state.tasks.resize(count);
  state.taken.resize(count);
  return take_all(bytes, std::span(&state.coarse, 1)) && take_all(bytes, std::span(state.tasks)) &&
         take_all(bytes, std::span(state.taken)) &&
         take_all(bytes, std::span(state.picture.pixels)) && bytes.empty();
}

}  // namespace

WindowState::WindowState(std::vector<WindowTask> plan, std::uint64_t coarse_samples, Picture empty)
    : tasks(std::move(plan)),
      taken(tasks.size()),
      coarse(coarse_samples),
      picture(std::move(empty)) {
  picture.pixels.assign(picture.width * picture.height * picture.channels, 0);
}

void save_windows(const std::string& file, const std::string& what, const WindowState& state) {
  const std::string head = head_of(what, state.picture);
  std::vector<std::byte> bytes;
  put_all(bytes, std::span<const char>(head));
  put(bytes, std::uint64_t{state.tasks.size()});
  put(bytes, state.coarse);
  put_all(bytes, std::span<const WindowTask>(state.tasks));
  put_all(bytes, std::span<const std::uint64_t>(state.taken));
  put_all(bytes, std::span<const float>(state.picture.pixels));
  write_whole(file, [&](const std::string& name) {
    write_bytes(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  });
}

WindowState load_windows(const std::string& file, const std::string& what, Picture empty) {
  const std::vector<std::byte> read = read_bytes(file);
  const std::string_view text(reinterpret_cast<const char*>(read.data()), read.size());
  if (!text.starts_with(mark)) throw std::runtime_error(file + ": no state of windows");
  const std::string head = head_of(what, empty);
  if (!text.starts_with(head)) throw std::runtime_error(file + ": was made with other options");
  WindowState state({}, 0, std::move(empty));
  if (!take_state(std::span(read).subspan(head.size()), state)) {
    throw std::runtime_error(file + ": is damaged");
  }
  return state;
}

}  // namespace farm
