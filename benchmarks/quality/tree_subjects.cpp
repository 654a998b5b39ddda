// SPDX-License-Identifier: MIT
#include "quality/tree_subjects.h"

#include <filesystem>

#include "quality/procedural_scene.h"

namespace quality {

std::span<const TreeSubject> tree_subjects() {
  static constexpr TreeSubject all[] = {
      // The rule of splitting and most members were chosen on the first three before.
      {"edge", true},
      {"fan", true},
      {"chess", true},
      {"zoneplate-high", true},
      {"softshadow", true},
      {"dandelion", true, "dandelion.png", true},
      {"averaging", true, "averaging.jpg"},
      {"plasma", true},
      {"clouds", true},
      {"strokes", true},
      {"star", false},
      {"checker", false},
      {"corner", false},
      {"sun", false},
      {"glossy", false},
      {"mountains", false, "mountains.png", true},
      {"embree", false, "embree.jpg"},
      {"leaves", false},
      {"cells", false},
      {"weave", false},
  };
  return all;
}

std::unique_ptr<scenes::Scene> make_subject(const std::string& name, int size,
                                            const SubjectFolders& folders) {
  if (auto procedural = make_procedural(name, size, size)) return procedural;
  std::string scene = name;
  for (const TreeSubject& subject : tree_subjects()) {
    if (subject.name != name || subject.file == nullptr) continue;
    const std::filesystem::path folder =
        subject.photograph ? folders.photographs : folders.documents;
    if (folder.empty() || !std::filesystem::exists(folder / subject.file)) return nullptr;
    scene = "image:" + (folder / subject.file).string();
  }
  return scenes::make_scene({.name = scene, .width = size, .height = size});
}

}  // namespace quality
