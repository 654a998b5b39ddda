// SPDX-License-Identifier: MIT
#include "painter_sloan.h"

#include <algorithm>
#include <cmath>

namespace baselines {
namespace {

/// What the descent reads: small, so that both children lie in one line of the cache.
struct Node {
  std::uint32_t children = 0;  // index of the first of two; 0 in a leaf
  std::uint32_t count = 1;     // samples below
  float error = 0;             // squared, expected of the part of the picture below
};

struct Leaf {
  Rgb radiance{};  // of its sample
  float x = 0;     // where that lies
  float y = 0;
  float variance = 0;  // expected in the cell
};

/// Halves a cell across its longer side.
void halve(const Rectangle& cell, Rectangle& first, Rectangle& second) {
  first = second = cell;
  if (cell.width() >= cell.height()) {
    first.right = second.left = (cell.left + cell.right) / 2;
  } else {
    first.bottom = second.top = (cell.top + cell.bottom) / 2;
  }
}

class Tree {
 public:
  Tree(Sampler& sampler, const Job& job, const PainterSloanSettings& settings)
      : sampler_(sampler), random_(job.seed), plane_(image_plane(job)), settings_(settings) {
    nodes_.reserve(2 * job.samples - 1);
    leaves_.reserve(2 * job.samples - 1);
    append({}, leaf(sampler_.take_in(plane_, random_)));
  }

  void refine() {
    std::uint32_t index = 0;
    Rectangle cell = plane_;
    path_.clear();
    while (nodes_[index].children != 0) {
      path_.push_back(index);
      Rectangle halves[2];
      halve(cell, halves[0], halves[1]);
      const std::size_t chosen = choose(nodes_[index].children) ? 1 : 0;
      index = nodes_[index].children + static_cast<std::uint32_t>(chosen);
      cell = halves[chosen];
    }
    path_.push_back(index);
    split(index, cell);
    for (auto i = path_.rbegin(); i != path_.rend(); ++i) update(nodes_[*i]);
  }

  void for_each_cell(const VisitCell& visit) const { visit_below(0, plane_, visit); }

 private:
  static Leaf leaf(const Sample& sample) {
    return {sample.rgb, static_cast<float>(sample.x), static_cast<float>(sample.y), 0};
  }

  void append(const Node& node, const Leaf& leaf) {
    nodes_.push_back(node);
    leaves_.push_back(leaf);
  }

  /// True for the second child.
  bool choose(std::uint32_t children) {
    const Node& first = nodes_[children];
    const Node& second = nodes_[children + 1];
    const float a = first.error / static_cast<float>(first.count);
    const float b = second.error / static_cast<float>(second.count);
    return a == b ? random_.below(2) == 1 : b > a;
  }

  void split(std::uint32_t index, const Rectangle& cell) {
    Rectangle halves[2];
    halve(cell, halves[0], halves[1]);
    const Leaf old = leaves_[index];
    const std::size_t holder = cell.width() >= cell.height()
                                   ? old.x >= static_cast<float>(halves[1].left)
                                   : old.y >= static_cast<float>(halves[1].top);
    const std::size_t empty = 1 - holder;
    Leaf children[2];
    children[holder] = old;
    children[empty] = leaf(sampler_.take_in(halves[empty], random_));

    // Two samples tell little: half of what was expected of the parent remains, so that an edge
    // that they miss is not forgotten at once.
    const float seen = squared_difference(children[0].radiance, children[1].radiance) / 2;
    const float variance = std::max(seen, old.variance / 2);
    const auto coverage = static_cast<float>(settings_.coverage * settings_.coverage);
    nodes_[index].children = static_cast<std::uint32_t>(nodes_.size());
    for (std::size_t i = 0; i < 2; ++i) {
      const auto area = static_cast<float>(halves[i].area());
      children[i].variance = variance;
      append({0, 1, area * area * (variance + coverage * std::max(area, 1.0f))}, children[i]);
    }
  }

  void update(Node& node) const {
    const Node& first = nodes_[node.children];
    const Node& second = nodes_[node.children + 1];
    node.count = first.count + second.count;
    node.error = first.error + second.error;
  }

  [[nodiscard]] float squared_difference(const Rgb& a, const Rgb& b) const {
    float sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const float difference =
          std::clamp(a[c], 0.0f, settings_.white) - std::clamp(b[c], 0.0f, settings_.white);
      sum += difference * difference;
    }
    return sum / 3;
  }

  void visit_below(std::uint32_t index, const Rectangle& cell, const VisitCell& visit) const {
    const Node& node = nodes_[index];
    if (node.children == 0) {
      visit(cell, leaves_[index].radiance);
      return;
    }
    Rectangle halves[2];
    halve(cell, halves[0], halves[1]);
    visit_below(node.children, halves[0], visit);
    visit_below(node.children + 1, halves[1], visit);
  }

  Sampler& sampler_;
  Random random_;
  Rectangle plane_;
  const PainterSloanSettings& settings_;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;  // of the same index as the node; those of other nodes are stale
  std::vector<std::uint32_t> path_;
};

/// Adds a cell's part of the mean of each pixel that it touches.
void add(const Rectangle& cell, const Rgb& radiance, std::size_t width, std::size_t height,
         std::vector<double>& sums) {
  const auto last_column = std::min(static_cast<std::size_t>(std::ceil(cell.right)), width);
  const auto last_row = std::min(static_cast<std::size_t>(std::ceil(cell.bottom)), height);
  for (auto y = static_cast<std::size_t>(cell.top); y < last_row; ++y) {
    const double top = static_cast<double>(y);
    const double tall = std::min(cell.bottom, top + 1) - std::max(cell.top, top);
    for (auto x = static_cast<std::size_t>(cell.left); x < last_column; ++x) {
      const double left = static_cast<double>(x);
      const double area = tall * (std::min(cell.right, left + 1) - std::max(cell.left, left));
      for (std::size_t c = 0; c < 3; ++c) {
        sums[(y * width + x) * 3 + c] += area * static_cast<double>(radiance[c]);
      }
    }
  }
}

}  // namespace

Rendering painter_sloan(const Radiance& radiance, const Job& job,
                        const PainterSloanSettings& settings) {
  return painter_sloan(radiance, job, settings, [](const Rectangle&, const Rgb&) {});
}

Rendering painter_sloan(const Radiance& radiance, const Job& job,
                        const PainterSloanSettings& settings, const VisitCell& visit) {
  Sampler sampler(radiance, job);
  Tree tree(sampler, job, settings);
  while (sampler.left() > 0) tree.refine();
  Rendering rendering = sampler.rendering();
  std::vector<double> sums(rendering.pixels.size(), 0.0);
  tree.for_each_cell([&](const Rectangle& cell, const Rgb& value) {
    add(cell, value, job.width, job.height, sums);
    visit(cell, value);
  });
  std::transform(sums.begin(), sums.end(), rendering.pixels.begin(),
                 [](double sum) { return static_cast<float>(sum); });
  return rendering;
}

}  // namespace baselines
