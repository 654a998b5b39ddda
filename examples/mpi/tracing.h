// SPDX-License-Identifier: MIT
/// \file
/// What all ranks do: trace packets of requests that rank 0 sends.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/sampler.h"
#include "mail.h"
#include "packet.h"

namespace farm {

/// Writes the values of requests, as many as there are channels for each. May throw.
using SampleFunction = std::function<void(std::span<const freqsynth::Request>, std::span<float>)>;

/// Something that is traced: letters of the kind Kind::work + k hold requests for work number k.
struct Work {
  PacketFormat format;
  SampleFunction sample;
  std::size_t portion = 16;  ///< samples of a call
};

/// Makes the answer to a letter that is no packet.
using OtherLetters = std::function<void(Letter&)>;

/// Answers packets until rank 0 ends the work. What the sampler throws is told to rank 0.
void serve(Mail& mail, std::span<const Work> works, freqsynth::ThreadPool& pool,
           const OtherLetters& others);

}  // namespace farm
