// SPDX-License-Identifier: MIT
/// \file
/// Whether a node of a tree goes on as one, or is split into four: the interface of a rule.
#pragma once

#include <cstdint>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/node_tree.h"

namespace freqsynth {

/// Decides for leaves that have had as many samples as a complete lattice has.
class SplitRule {
 public:
  virtual ~SplitRule() = default;

  /// Whether a leaf that has had 81 samples goes on as one, to 289; else it is split. The same
  /// whenever it is asked about the same samples.
  virtual bool goes_on(const NodeTree& tree, std::uint32_t leaf) = 0;

 protected:
  SplitRule() = default;
  SplitRule(const SplitRule&) = default;             ///< only as a part of a rule that is copied
  SplitRule& operator=(const SplitRule&) = default;  ///< only as a part of a rule that is copied
};

}  // namespace freqsynth
