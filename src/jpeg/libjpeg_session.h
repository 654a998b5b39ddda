// SPDX-License-Identifier: MIT
/// \file
/// libjpeg in C++: its errors as exceptions, its objects destroyed.
#pragma once

#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it and does not include it
#include <stdexcept>
#include <string>
#include <type_traits>

#include <jpeglib.h>
// After jpeglib.h, which it needs.
#include <jerror.h>

namespace freqsynth::detail {

/// libjpeg reports errors by a call that must not return. This one leaves by longjmp, for
/// exceptions cannot be relied on to pass through C.
struct Errors : jpeg_error_mgr {
  std::jmp_buf jump;
  char message[JMSG_LENGTH_MAX];

  Errors() {
    jpeg_std_error(this);
    error_exit = &leave;
    output_message = [](j_common_ptr) {};
    // Negative levels warn of damaged data; all others only tell how things go.
    emit_message = [](j_common_ptr info, int level) {
      if (level < 0) leave(info);
    };
  }

  [[noreturn]] static void leave(j_common_ptr info) {
    auto* errors = static_cast<Errors*>(info->err);
    errors->format_message(info, errors->message);
    std::longjmp(errors->jump, 1);
  }

  /// With a message that is not one of libjpeg's.
  [[noreturn]] static void leave_with(j_common_ptr info, const char* text) {
    auto* errors = static_cast<Errors*>(info->err);
    std::snprintf(errors->message, sizeof errors->message, "%s", text);
    std::longjmp(errors->jump, 1);
  }
};

/// Calls `body`, which calls libjpeg. It must hold no object with a destructor: longjmp runs none.
/// \throws std::runtime_error with libjpeg's message.
template <class Body>
void guarded(Errors& errors, const char* function, const Body& body) {
  static_assert(std::is_trivially_destructible_v<Body>);
  if (setjmp(errors.jump) != 0) {
    throw std::runtime_error("freqsynth: " + std::string(function) + ": " + errors.message);
  }
  body();
}

/// A libjpeg object that destroys itself. It must be created within `guarded`.
template <class Info>
struct Session {
  Errors errors;
  Info info{};

  Session() { info.err = &errors; }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session() { jpeg_destroy(common()); }

  j_common_ptr common() { return reinterpret_cast<j_common_ptr>(&info); }
};

}  // namespace freqsynth::detail
