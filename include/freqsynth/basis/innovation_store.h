// SPDX-License-Identifier: MIT
/// \file
/// One innovation list (innovation_list.h) for all who ask for the same one, in the whole process.
#pragma once

#include <memory>
#include <span>

#include "freqsynth/basis/box_covariance.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/basis/covariance.h"
#include "freqsynth/basis/innovation_list.h"

namespace freqsynth {

/// The list of a prior, positions and averages: that which somebody in the process still holds, or
/// a new one. It goes with the last who holds it; nothing is kept for those who come later. May be
/// called from several threads.
/// \throws std::invalid_argument like InnovationList.
/// \throws std::bad_alloc; then nothing has changed.
[[nodiscard]] FREQSYNTH_API std::shared_ptr<const InnovationList> shared_innovations(
    const Covariance& covariance, std::span<const UnitPoint> positions, const AverageGrid& grid);

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/basis/innovation_store.inl"
#endif
