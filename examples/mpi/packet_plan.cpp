// SPDX-License-Identifier: MIT
#include "packet_plan.h"

#include <algorithm>

namespace farm {

std::size_t packet_size(const PacketSettings& settings, std::size_t left, double speed,
                        double all) {
  const double fair = static_cast<double>(left) * speed / all / 2;
  const double size =
      std::max(std::min(fair, settings.most_seconds * speed), settings.least_seconds * speed);
  const auto whole = static_cast<std::size_t>(std::min(size, 1e9));
  return std::clamp<std::size_t>(whole, 1, std::min(left, settings.most_samples));
}

}  // namespace farm
