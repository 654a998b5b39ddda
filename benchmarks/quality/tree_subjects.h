// SPDX-License-Identifier: MIT
/// \file
/// What freqsynth_tree measures: the one half of it is for choosing, the other is reported.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "scenes/scene.h"

namespace quality {

/// Where files are; an empty folder has none.
struct SubjectFolders {
  std::string documents = "docs";  ///< of this project
  std::string photographs;         ///< that examples/photographs.sh has made
};

/// One scene or picture.
struct TreeSubject {
  const char* name;
  bool choosing;  ///< members, rules and parameters may be chosen on it; else it is only reported
  const char* file = nullptr;  ///< of a picture
  bool photograph = false;     ///< the file is in the folder of photographs
};

/// Five scenes and five pictures to choose on, then five and five to report.
[[nodiscard]] std::span<const TreeSubject> tree_subjects();

/// Makes one; `name` may be that of any scene as well. \return null for one whose file is not
/// there.
/// \throws like scenes::make_scene().
[[nodiscard]] std::unique_ptr<scenes::Scene> make_subject(const std::string& name, int size,
                                                          const SubjectFolders& folders);

}  // namespace quality
