// SPDX-License-Identifier: MIT
/// \file
/// Work that meets a fault of memory, and is begun again.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <vector>

#include "faults/failing_new.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"

namespace faults {

/// Calls work(), in which allocation `k` fails, again and again until it goes through.
/// \return whether the fault came to pass
template <class Work>
bool survive(std::size_t k, Work&& work) {
  const FailAllocation fault(k);
  for (int attempt = 0; attempt < 2; ++attempt) {
    try {
      work();
      return fault.failed();
    } catch (const std::bad_alloc&) {
      EXPECT_TRUE(fault.failed());
    }
  }
  ADD_FAILURE() << "allocation " << k << " failed once, the work twice";
  return true;
}

/// A loop of the host's own, in portions of 7, which gives every fifth request back once.
inline void loop(freqsynth::Synthesizer& engine, std::uint64_t& answered,
                 std::vector<freqsynth::Request>& requests, std::vector<float>& values) {
  for (;;) {
    requests.resize(7);
    const std::size_t count = engine.request(requests);
    if (count == 0) return;
    for (std::size_t i = 0; i < count; ++i) {
      if ((requests[i].id + answered) % 5 == 0 && count > 1 && i == 0) {
        engine.give_back(std::span(requests).subspan(i, 1));
        continue;
      }
      values[0] = helpers::picture(requests[i].x, requests[i].y);
      engine.deliver(std::span(requests).subspan(i, 1), std::span(values).first(1));
      ++answered;
    }
  }
}

}  // namespace faults
