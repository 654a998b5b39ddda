// SPDX-License-Identifier: MIT
#include "messages.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

namespace live {
namespace {

using nlohmann::json;

json object_of(const std::string& message) {
  json object = json::parse(message, nullptr, false);
  if (!object.is_object()) throw std::invalid_argument("not a JSON object");
  return object;
}

/// So many numbers; empty when there is null or nothing.
std::vector<double> numbers_of(const json& object, const char* name, std::size_t count) {
  const auto found = object.find(name);
  if (found == object.end() || found->is_null()) return {};
  const std::string wanted = std::string(name) + ": not " + std::to_string(count) + " numbers";
  if (!found->is_array() || found->size() != count) throw std::invalid_argument(wanted);
  std::vector<double> numbers;
  for (const json& number : *found) {
    if (!number.is_number() || !std::isfinite(number.get<double>())) {
      throw std::invalid_argument(wanted);
    }
    numbers.push_back(number.get<double>());
  }
  return numbers;
}

double number_of(const json& object, const char* name, double least, double most) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_number() || !(found->get<double>() >= least) ||
      !(found->get<double>() <= most)) {
    throw std::invalid_argument(std::string(name) + ": not a number in range");
  }
  return found->get<double>();
}

}  // namespace

std::string state_message(const Session& session, const Revision* revision) {
  const Options& options = session.options();
  const View view = session.view();
  json state{{"scene", options.scene}, {"width", options.width},  {"height", options.height},
             {"stops", view.stops},    {"quality", view.quality}, {"frame", nullptr},
             {"revision", 0}};
  if (const auto frame = session.attention().frame) {
    state["frame"] = {frame->left, frame->top, frame->right, frame->bottom};
  }
  if (revision != nullptr) {
    state["revision"] = revision->number;
    state["samples"] = revision->samples;
    state["samples_per_pixel"] = revision->samples_per_pixel;
    state["most_samples"] = revision->most_samples;
    state["seconds"] = revision->seconds;
    state["finished"] = revision->finished;
    state["error"] = nullptr;
    if (revision->predicted_error >= 0) state["error"] = revision->predicted_error;
  }
  // A file's name may be no text.
  return state.dump(-1, ' ', false, json::error_handler_t::replace);
}

Attention read_attention(const std::string& message) {
  const json object = object_of(message);
  Attention attention;
  const std::vector<double> frame = numbers_of(object, "frame", 4);
  if (!frame.empty()) {
    if (!(frame[0] < frame[2] && frame[1] < frame[3])) {
      throw std::invalid_argument("frame: not left, top, right, bottom");
    }
    attention.frame = Frame{frame[0], frame[1], frame[2], frame[3]};
  }
  const std::vector<double> pointer = numbers_of(object, "pointer", 2);
  if (!pointer.empty()) attention.pointer = Point{pointer[0], pointer[1]};
  return attention;
}

View read_view(const std::string& message) {
  const json object = object_of(message);
  return {number_of(object, "stops", -8, 8),
          static_cast<int>(number_of(object, "quality", 1, 100))};
}

}  // namespace live
