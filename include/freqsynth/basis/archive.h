// SPDX-License-Identifier: MIT
/// \file
/// The form in which states and images are saved: a header, then sections, each with its name, its
/// length and a check value. Numbers are little-endian whatever the machine is, floats their bits.
///
/// What is saved lists its parts once, in a function of an archive, which is a StateWriter or a
/// StateReader: both have the same members. All of this is internal.
///
/// Bytes: 8 that say that it is a file of this library, 4 that name its kind, 4 of its format's
/// version, 4 of check value. Each section: 4 that name it, 8 of length, 4 of check value; as many
/// bytes as the length says, 4 of check value. The last section is END and empty. A check value is
/// the CRC-32C of all bytes before it but other check values.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "freqsynth/basis/byte_stream.h"
#include "freqsynth/basis/config.h"

namespace freqsynth::detail {

/// CRC-32C of bytes, when that of those before them is `before`.
[[nodiscard]] FREQSYNTH_API std::uint32_t crc32c(std::uint32_t before,
                                                 std::span<const std::byte> bytes);

/// What is saved.
struct ArchiveKind {
  const char* name;       ///< as people call it
  char tag[5];            ///< four letters in the file
  std::uint32_t version;  ///< of the format
};

inline constexpr ArchiveKind synthesis_kind{"saved synthesis", "SYNT", 1};
inline constexpr ArchiveKind tree_synthesis_kind{"saved synthesis by kriging", "TREE", 1};
inline constexpr ArchiveKind image_kind{"saved frequency image", "IMAG", 1};

/// Unsigned integer of the size of a number.
template <class T>
using BitsOf = std::conditional_t<
    sizeof(T) == 1, std::uint8_t,
    std::conditional_t<sizeof(T) == 2, std::uint16_t,
                       std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>>;

template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Numbers to bytes, sizeof(T) for each.
template <Number T>
void encode(std::span<const T> numbers, std::byte* out) {
  for (const T number : numbers) {
    const auto bits = std::bit_cast<BitsOf<T>>(number);
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      *out++ = static_cast<std::byte>(static_cast<std::uint64_t>(bits) >> (8 * i) & 0xff);
    }
  }
}

/// Bytes to numbers.
template <Number T>
void decode(const std::byte* bytes, std::span<T> numbers) {
  for (T& number : numbers) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bits |= std::to_integer<std::uint64_t>(*bytes++) << (8 * i);
    number = std::bit_cast<T>(static_cast<BitsOf<T>>(bits));
  }
}

/// Writes an archive.
class FREQSYNTH_API StateWriter {
 public:
  static constexpr bool loading = false;

  /// Begins it.
  StateWriter(const ByteSink& sink, const ArchiveKind& kind);

  /// Writes a section. body() writes its content; it is called twice, the first time to find out
  /// how long it is.
  template <class Body>
  void section(const char* tag, Body&& body) {
    counting_ = true;
    length_ = 0;
    body();
    counting_ = false;
    open(tag);
    body();
    close();
  }

  /// A number.
  template <Number T>
  void number(const T& number) {
    put(std::span<const T>(&number, 1));
  }
  void number(const bool& value) { number(static_cast<std::uint8_t>(value ? 1 : 0)); }
  /// A number of things.
  void count(const std::size_t& count) { number(std::uint64_t{count}); }
  /// Numbers, as many as the reader knows, one after the other.
  template <class Numbers>
  void array(const Numbers& numbers) {
    put(std::span<const typename Numbers::value_type>(numbers));
  }
  template <Number T>
  void put(std::span<const T> numbers) {
    length_ += numbers.size_bytes();
    if (counting_) return;
    while (!numbers.empty()) {
      const std::size_t most = room() / sizeof(T);
      const std::size_t some = numbers.size() < most ? numbers.size() : most;
      encode(numbers.first(some), buffer_.data() + used_);
      used_ += some * sizeof(T);
      numbers = numbers.subspan(some);
    }
  }
  /// Numbers and how many there are, `most` at most.
  template <Number T>
  void list(const std::vector<T>& numbers, std::size_t) {
    count(numbers.size());
    array(numbers);
  }
  /// The same of other things, each of which one(thing) writes.
  template <class T, class One>
  void list(const std::vector<T>& things, std::size_t, One&& one) {
    count(things.size());
    for (const T& thing : things) one(thing);
  }

  /// What the reader is to make sure of.
  void check(bool) {}

  /// Ends it.
  void finish();

 private:
  static constexpr std::size_t buffer_size = std::size_t{1} << 16;

  /// Room in the buffer, for a number at least.
  std::size_t room() {
    if (buffer_size - used_ < sizeof(std::uint64_t)) flush();
    return buffer_size - used_;
  }
  void open(const char* tag);
  void close() { put_check(); }
  void flush();
  void put_check();

  ByteSink sink_;
  bool counting_ = false;
  std::uint64_t length_ = 0;  // of the section
  std::uint32_t crc_ = 0;
  std::vector<std::byte> buffer_;
  std::size_t used_ = 0;
};

/// Reads an archive. All faults are told as std::runtime_error; what was read so far is of no use
/// then. Takes no more memory than there are bytes.
class FREQSYNTH_API StateReader {
 public:
  static constexpr bool loading = true;

  /// Begins to read one of that kind.
  StateReader(const ByteSource& source, const ArchiveKind& kind);

  /// Reads a section. body() reads its content.
  template <class Body>
  void section(const char* tag, Body&& body) {
    open(tag);
    body();
    close();
  }

  /// Bytes of the section that are left, as its length says.
  [[nodiscard]] std::uint64_t remaining() const { return remaining_ + (filled_ - used_); }

  /// A number.
  template <Number T>
  void number(T& number) {
    take(std::span<T>(&number, 1));
  }
  void number(bool& value) {
    std::uint8_t byte = 0;
    number(byte);
    check(byte <= 1);
    value = byte != 0;
  }
  /// A number of things.
  void count(std::size_t& count);
  /// Numbers, as many as there are to be, one after the other.
  template <class Numbers>
  void array(Numbers&& numbers) {
    take(std::span<typename std::remove_cvref_t<Numbers>::value_type>(numbers));
  }
  template <Number T>
  void take(std::span<T> numbers) {
    while (!numbers.empty()) {
      const std::size_t most = available(sizeof(T)) / sizeof(T);
      const std::size_t some = numbers.size() < most ? numbers.size() : most;
      decode(buffer_.data() + used_, numbers.first(some));
      used_ += some * sizeof(T);
      numbers = numbers.subspan(some);
    }
  }
  /// Numbers and how many there are, `most` at most.
  template <Number T>
  void list(std::vector<T>& numbers, std::size_t most) {
    std::size_t size = 0;
    count(size);
    check(size <= most && size <= remaining() / sizeof(T));
    numbers.clear();
    // The length may lie: memory is taken as the numbers come.
    while (numbers.size() < size) {
      const std::size_t before = numbers.size();
      constexpr std::size_t step = std::size_t{1} << 18;
      numbers.resize(size - before < step ? size : before + step);
      array(std::span<T>(numbers).subspan(before));
    }
  }
  /// The same of other things, each of which one(thing) reads.
  template <class T, class One>
  void list(std::vector<T>& things, std::size_t most, One&& one) {
    std::size_t size = 0;
    count(size);
    check(size <= most && size <= remaining());
    things.clear();
    for (std::size_t i = 0; i < size; ++i) one(things.emplace_back());
  }

  /// Refuses a section that holds what it cannot.
  void check(bool good) {
    if (!good) [[unlikely]] {
      fail_section("holds what it cannot");
    }
  }
  /// Refuses what is read: a sentence that the saved thing is the subject of. Says rather that the
  /// section is damaged, when it is.
  [[noreturn]] void fail(const std::string& what);
  /// The same, naming the section.
  [[noreturn]] void fail_section(const std::string& what) {
    fail(what + ", in section " + section_);
  }

  /// Makes sure that it ends here.
  void finish();

 private:
  static constexpr std::size_t buffer_size = std::size_t{1} << 16;

  /// Makes sure that at least so many bytes of the section are in the buffer. \return how many are
  std::size_t available(std::size_t least) {
    if (filled_ - used_ < least) fill(least);
    return filled_ - used_;
  }
  void open(const char* tag);
  void close();
  void fill(std::size_t least);
  /// Reads bytes past the buffer, into its front.
  const std::byte* read(std::size_t count);
  [[noreturn]] void refuse(const std::string& what) const;
  [[noreturn]] void refuse_damaged() const;
  [[noreturn]] void refuse_short() const;
  [[nodiscard]] bool check_value_fits();

  ByteSource source_;
  std::string name_;     // of what is read
  std::string section_;  // that is read, if any
  std::uint32_t crc_ = 0;
  std::uint64_t remaining_ = 0;  // bytes of the section that are not in the buffer
  std::vector<std::byte> buffer_;
  std::size_t used_ = 0, filled_ = 0;
};

}  // namespace freqsynth::detail

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/basis/archive.inl"
#endif
