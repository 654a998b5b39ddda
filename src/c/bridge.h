// SPDX-License-Identifier: MIT
/// \file
/// What the functions of the C interface have in common: handles, arguments, and exceptions that
/// become a status.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <span>
#include <string>
#include <utility>

#include "freqsynth/basis/check.h"
#include "freqsynth/c/freqsynth.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/freqsynth.h"
#include "freqsynth/synthesizer_file.h"

struct freqsynth_synthesizer {
  explicit freqsynth_synthesizer(freqsynth::SynthesisSettings settings)
      : engine(std::move(settings)) {}
  freqsynth_synthesizer(const std::string& file, const freqsynth::SynthesisSettings& settings)
      : engine(freqsynth::load_synthesizer(file, settings)) {}
  freqsynth::Synthesizer engine;
};

struct freqsynth_image {
  freqsynth::FrequencyImage image;
};

struct freqsynth_list {
  freqsynth::SharedInverseList list;
};

struct freqsynth_thread_pool {
  explicit freqsynth_thread_pool(std::size_t threads) : pool(threads) {}
  freqsynth::ThreadPool pool;
};

namespace freqsynth::detail {

/// A callback of the host that said no.
class FREQSYNTH_API CallbackFailure : public std::exception {
 public:
  CallbackFailure(const char* callback, int code) {
    std::snprintf(text_, sizeof text_, "freqsynth: the %s returned %d", callback, code);
  }
  [[nodiscard]] const char* what() const noexcept override { return text_; }

 private:
  char text_[80];
};

/// Status of the exception that is being handled, whose text this thread keeps. What ends a thread
/// goes on. Of use to the component with JPEG as well.
[[nodiscard]] FREQSYNTH_API freqsynth_status status_of_exception();

/// work(), whose exceptions become a status.
template <class Work>
freqsynth_status guarded(const Work& work) {
  try {
    work();
    return FREQSYNTH_OK;
  } catch (...) {
    return status_of_exception();
  }
}

/// The object behind a handle. \throws std::invalid_argument when there is none.
template <class T>
T& object(T* handle, const char* name) {
  if (handle == nullptr) refuse(std::string(name) + " is NULL");
  return *handle;
}

/// \throws std::invalid_argument when there is no memory for some values.
template <class T>
std::span<T> array(T* values, std::size_t count, const char* name) {
  if (values == nullptr && count > 0) refuse(std::string(name) + " is NULL");
  return {values, count};
}

/// Size of a struct as the caller knows it.
inline std::size_t known_size(std::size_t size, const char* name, const char* how) {
  if (size < 2 * sizeof(std::size_t)) {
    refuse(std::string(name) + ".struct_size is " + std::to_string(size) + ", not " + how);
  }
  return size;
}

/// Settings as the caller knows them, and defaults for what it does not know.
/// \throws std::invalid_argument when it has set what this version does not know.
template <class T>
T read_settings(const T* from, void (*init)(T*, std::size_t), const char* name) {
  T all;
  init(&all, sizeof all);
  if (from == nullptr) return all;
  const std::size_t size = known_size(from->struct_size, name, "set by its function ..._init()");
  const auto* const bytes = reinterpret_cast<const unsigned char*>(from);
  for (std::size_t i = sizeof all; i < size; ++i) {
    if (bytes[i] != 0) refuse(std::string(name) + " has members of a newer version");
  }
  std::memcpy(&all, from, std::min(size, sizeof all));
  return all;
}

/// Fills in as much of a result as the caller knows.
template <class T>
void write_result(T result, T* to, const char* name) {
  const std::size_t size = known_size(object(to, name).struct_size, name, "the size of the struct");
  result.struct_size = size;
  std::memset(static_cast<void*>(to), 0, size);
  std::memcpy(static_cast<void*>(to), &result, std::min(size, sizeof result));
}

/// Fills in as much of the defaults as the caller knows.
template <class T>
void write_defaults(T defaults, T* to, std::size_t size) {
  if (to == nullptr) return;
  defaults.struct_size = size;
  std::memset(static_cast<void*>(to), 0, size);
  std::memcpy(static_cast<void*>(to), &defaults, std::min(size, sizeof defaults));
}

/// A number of an enumeration with the values 0 .. most.
template <class E>
E enumerator(std::int32_t value, E most, const char* name) {
  if (value < 0 || value > static_cast<std::int32_t>(most)) {
    refuse(std::string(name) + " is " + std::to_string(value) + ", not in 0.." +
           std::to_string(static_cast<std::int32_t>(most)));
  }
  return static_cast<E>(value);
}

/// \throws std::invalid_argument when the file has no name.
inline std::string file_name(const char* file) {
  if (file == nullptr) refuse("file is NULL");
  return file;
}

static_assert(FREQSYNTH_STOP_SAMPLES == 1 + static_cast<int>(StopReason::samples));
static_assert(FREQSYNTH_STOP_THRESHOLD == 1 + static_cast<int>(StopReason::threshold));
static_assert(FREQSYNTH_STOP_EXHAUSTED == 1 + static_cast<int>(StopReason::exhausted));
static_assert(FREQSYNTH_STOP_CANCELLED == 1 + static_cast<int>(StopReason::cancelled));
static_assert(FREQSYNTH_STOP_WAITING == 1 + static_cast<int>(StopReason::waiting));
static_assert(FREQSYNTH_STOP_UNUSABLE == 1 + static_cast<int>(StopReason::unusable));
static_assert(FREQSYNTH_STOP_SECONDS == 1 + static_cast<int>(StopReason::seconds));
static_assert(FREQSYNTH_STOP_TARGET_RMSE == 1 + static_cast<int>(StopReason::target_rmse));
/// As the host sees it.
inline std::int32_t reason_of(StopReason reason) { return 1 + static_cast<std::int32_t>(reason); }
freqsynth_progress progress_of(const Progress& now);

SynthesisSettings settings_of(const freqsynth_settings* settings);
StopRule stop_rule_of(const freqsynth_stop_rule* rule);
FinishSettings finish_settings_of(const freqsynth_finish_settings* settings);
FREQSYNTH_API ReconstructionSettings
reconstruction_settings_of(const freqsynth_reconstruction_settings* settings);

}  // namespace freqsynth::detail
