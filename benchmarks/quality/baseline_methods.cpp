#include <string>

#include "baselines/methods.h"
#include "methods.h"

namespace quality::detail {

void add_baselines(std::vector<Method>& methods) {
  for (const baselines::Method& each : baselines::methods()) {
    methods.push_back({std::string(each.name), std::string(each.description),
                       std::string(each.paper), each.render, each.least_rate});
  }
}

}  // namespace quality::detail
