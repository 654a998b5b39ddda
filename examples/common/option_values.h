// SPDX-License-Identifier: MIT
/// \file
/// The values of options, from text to numbers.
#pragma once

#include <charconv>
#include <concepts>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

/// The command line is wrong.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// \throws UsageError that names the option, its value, and what was wanted instead.
[[noreturn]] void refuse(std::string_view option, std::string_view value, std::string_view wanted);

/// \return whether the text is a number, and nothing else
template <class Number>
bool read_all(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

// All of these leave `number` as it is when the text is empty, and throw UsageError when it is
// wrong.

/// A whole number from `least` on.
template <std::unsigned_integral Number>
void read_count(std::string_view option, const std::string& text, Number least, Number& number) {
  if (text.empty()) return;
  if (!read_all(text, number) || number < least) {
    refuse(option, text, "a whole number from " + std::to_string(least));
  }
}

/// A finite number > 0, also as a fraction: 1/64.
void read_positive(std::string_view option, const std::string& text, double& number);

/// WIDTHxHEIGHT, both in 1..65536.
void read_size(std::string_view option, const std::string& text, std::size_t& width,
               std::size_t& height);
