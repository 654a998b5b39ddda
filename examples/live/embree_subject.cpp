// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>
#include <vector>

#include "embree/glue.h"
#include "subject.h"

namespace live {
namespace {

class EmbreeSubject : public Subject {
 public:
  explicit EmbreeSubject(embree_host::Renderer renderer) : renderer_(std::move(renderer)) {}
  void radiance(std::span<const freqsynth::Request> requests, std::span<float> rgb) const override {
    constexpr std::size_t all = embree_host::channels;
    std::vector<float> values(requests.size() * all);
    embree_host::Sampler{renderer_}(requests, values);
    for (std::size_t i = 0; i < requests.size(); ++i) {
      std::copy_n(values.data() + i * all, 3, rgb.data() + i * 3);
    }
  }
  [[nodiscard]] bool noisy() const override { return true; }

 private:
  embree_host::Renderer renderer_;
};

}  // namespace

std::unique_ptr<Subject> make_embree_subject(std::size_t width, std::size_t height) {
  embree_host::View view;
  embree_host::Model model = embree_host::make_colonnade(view);
  return std::make_unique<EmbreeSubject>(embree_host::Renderer(
      embree_host::Geometry(std::move(model)), view, embree_host::Sky{}, width, height));
}

}  // namespace live
