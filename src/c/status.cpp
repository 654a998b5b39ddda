// SPDX-License-Identifier: MIT
#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>

#include "c/bridge.h"

// Ending a thread from outside unwinds its stack by an exception that may not be swallowed.
#if defined(__GLIBCXX__) && defined(__linux__)
#include <cxxabi.h>
#endif

namespace freqsynth::detail {
namespace {

thread_local char last_error[512] = "";

freqsynth_status failed(freqsynth_status status, const char* text) {
  std::snprintf(last_error, sizeof last_error, "%s", text);
  return status;
}

}  // namespace

freqsynth_status status_of_exception() {
  try {
    throw;
#if defined(__GLIBCXX__) && defined(__linux__)
  } catch (abi::__forced_unwind&) {
    throw;
#endif
  } catch (const CallbackFailure& error) {
    return failed(FREQSYNTH_CALLBACK_FAILED, error.what());
  } catch (const std::invalid_argument& error) {
    return failed(FREQSYNTH_INVALID_ARGUMENT, error.what());
  } catch (const std::bad_alloc&) {
    return failed(FREQSYNTH_OUT_OF_MEMORY, "freqsynth: not enough memory");
  } catch (const std::length_error&) {
    return failed(FREQSYNTH_OUT_OF_MEMORY, "freqsynth: more memory than there can be");
  } catch (const std::runtime_error& error) {
    return failed(FREQSYNTH_SYSTEM_ERROR, error.what());
  } catch (const std::exception& error) {
    return failed(FREQSYNTH_INTERNAL_ERROR, error.what());
  } catch (...) {
    return failed(FREQSYNTH_INTERNAL_ERROR, "freqsynth: an exception of unknown type");
  }
}

}  // namespace freqsynth::detail

const char* freqsynth_last_error(void) { return freqsynth::detail::last_error; }

const char* freqsynth_version(void) { return FREQSYNTH_VERSION; }
