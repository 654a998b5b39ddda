// SPDX-License-Identifier: MIT
#include "subject.h"

#include <utility>

#include "common/sampling.h"

namespace live {
namespace {

class SceneSubject : public Subject {
 public:
  explicit SceneSubject(std::unique_ptr<scenes::Scene> scene) : scene_(std::move(scene)) {}
  void radiance(std::span<const freqsynth::Request> requests, std::span<float> rgb) const override {
    SceneSampler(*scene_, 3)(requests, rgb);
  }
  [[nodiscard]] bool noisy() const override { return scene_->noisy(); }

 private:
  std::unique_ptr<scenes::Scene> scene_;
};

}  // namespace

std::unique_ptr<Subject> make_subject(const std::string& name, std::size_t width,
                                      std::size_t height) {
#ifdef LIVE_HAS_EMBREE
  if (name == embree_name) return make_embree_subject(width, height);
#else
  if (name == embree_name) throw UsageError("--scene embree: built without Embree");
#endif
  return std::make_unique<SceneSubject>(named_scene(
      {.name = name, .width = static_cast<int>(width), .height = static_cast<int>(height)}));
}

}  // namespace live
