// SPDX-License-Identifier: MIT
// K2: edges along the axes, and text.

#include <limits>

#include "field_cases/named_fields.h"
#include "fields/field_helpers.h"

namespace {

// An aim that is not reached yet; docs/field_cases.md tells how far it is.
TEST(AxisEdges, DISABLED_RandomRectanglesAreNotAboveJittered) {
  helpers::expect_not_above_jittered(field_cases::random_rectangles, 24);
}
// An aim that is not reached yet; docs/field_cases.md tells how far it is.
TEST(AxisEdges, DISABLED_RandomLinesAreNotAboveJittered) {
  helpers::expect_not_above_jittered(field_cases::random_lines, 24);
}
// An aim that is not reached yet; docs/field_cases.md tells how far it is.
TEST(AxisEdges, DISABLED_RandomStemsAreNotAboveJittered) {
  helpers::expect_not_above_jittered(field_cases::random_stems, 24);
}
// An aim that is not reached yet; docs/field_cases.md tells how far it is.
TEST(AxisEdges, DISABLED_RandomCheckersAreNotAboveJittered) {
  helpers::expect_not_above_jittered(field_cases::random_checker, 24);
}

// An aim that is not reached yet; docs/field_cases.md tells how far it is.
TEST(AxisEdges, DISABLED_NamedOnesAreNotAboveJittered) {
  const std::vector<field_cases::Field> fields{
      field_cases::checker_field("checker", 128, 128, 8, 0, 0),
      field_cases::checker_field("checker, shifted", 128, 128, 8, -0.01, -0.01),
      field_cases::checker_field("checker, 9", 128, 128, 9, 0, 0),
      field_cases::rectangle_and_line(0),
      field_cases::rectangle_and_line(0.4),
      field_cases::text_stems(0),
      field_cases::text_stems(0.37)};
  helpers::expect_not_above_jittered(
      [&](std::uint64_t, std::uint64_t number) { return fields[number - 1]; }, fields.size());
}

// An aim that is not reached yet; docs/field_cases.md tells how far it is.
TEST(AxisEdges, DISABLED_TextEndsByItselfBelowTenSamplesPerPixel) {
  const field_cases::Field field = field_cases::text_stems(0);
  const field_cases::Sampler sampler = [&](double x, double y, std::uint64_t,
                                           std::span<float> values) {
    values[0] = static_cast<float>(255 * field_cases::display(field.value(x, y)));
  };
  for (const int quality : {50, 75, 90}) {
    freqsynth::QuantizationSettings tables;
    tables.luminance = freqsynth::scale_table(freqsynth::luminance_table(), quality);
    auto settings = field_cases::settings_of(field.width, field.height);
    settings.quantization = freqsynth::quantization_target(tables, 1);
    std::uint64_t samples = 0;
    (void)field_cases::synthesize_image(sampler, settings, std::numeric_limits<double>::infinity(),
                                        1, &samples);
    EXPECT_LT(static_cast<double>(samples) / (128 * 128), 10) << "quality " << quality;
  }
}

}  // namespace
