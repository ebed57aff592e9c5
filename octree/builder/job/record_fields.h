#pragma once

#include <Eigen/Core>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

/// Converts values to the bytes of a record and back. The fields of a struct are listed once for
/// both directions, in a function beside it that takes a RecordWriter or a RecordReader:
///
///     template <class Record, class Value>
///       requires std::same_as<std::remove_const_t<Value>, Thing>
///     void fields(Record& record, Value& thing) { record(thing.first, thing.second); }
namespace planetree::octree {

template <class Value>
concept Plain = std::is_arithmetic_v<Value> || std::is_enum_v<Value>;

class RecordWriter {
 public:
  template <class... Values>
  void operator()(const Values&... values) {
    (put(values), ...);
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  void put_bytes(const void* from, std::size_t count) {
    const auto* const begin = static_cast<const std::byte*>(from);
    bytes_.insert(bytes_.end(), begin, begin + count);
  }
  template <Plain Value>
  void put(const Value& value) {
    put_bytes(&value, sizeof value);
  }
  template <class Value>
  void put(const Value& value) {
    fields(*this, value);
  }
  template <int kRows, int kColumns>
  void put(const Eigen::Matrix<double, kRows, kColumns>& values) {
    put_bytes(values.data(), sizeof(double) * kRows * kColumns);
  }
  template <class Value, std::size_t kCount>
  void put(const std::array<Value, kCount>& values) {
    for (const Value& value : values) put(value);
  }
  template <class Value>
  void put(const std::vector<Value>& values) {
    put(std::uint64_t{values.size()});
    for (const Value& value : values) put(value);
  }
  template <class Value>
  void put(const std::optional<Value>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  void put(const std::string& text) {
    put(std::uint64_t{text.size()});
    put_bytes(text.data(), text.size());
  }

  std::vector<std::byte> bytes_;
};

/// Reads values from a record. If the record is too short, fits() is false and the values are of no
/// use.
class RecordReader {
 public:
  explicit RecordReader(std::span<const std::byte> bytes) : left_(bytes) {}

  template <class... Values>
  void operator()(Values&... values) {
    (get(values), ...);
  }
  /// Whether the record had all values that were read, and no further bytes.
  bool fits() const { return good_ && left_.empty(); }

 private:
  void get_bytes(void* to, std::size_t count) {
    good_ = good_ && count <= left_.size();
    if (!good_ || count == 0) return;
    std::memcpy(to, left_.data(), count);
    left_ = left_.subspan(count);
  }
  template <Plain Value>
  void get(Value& value) {
    get_bytes(&value, sizeof value);
  }
  void get(bool& value) {
    std::uint8_t byte = value ? 1 : 0;
    get(byte);
    value = byte != 0;
  }
  template <class Value>
  void get(Value& value) {
    fields(*this, value);
  }
  template <int kRows, int kColumns>
  void get(Eigen::Matrix<double, kRows, kColumns>& values) {
    get_bytes(values.data(), sizeof(double) * kRows * kColumns);
  }
  template <class Value, std::size_t kCount>
  void get(std::array<Value, kCount>& values) {
    for (Value& value : values) get(value);
  }
  template <class Value>
  void get(std::vector<Value>& values) {
    values.resize(get_count());
    for (Value& value : values) get(value);
  }
  template <class Value>
  void get(std::optional<Value>& value) {
    bool there = false;
    get(there);
    if (there) get(value.emplace());
  }
  void get(std::string& text) {
    text.resize(get_count());
    get_bytes(text.data(), text.size());
  }
  // Every element takes at least one byte, so a greater count is wrong.
  std::size_t get_count() {
    std::uint64_t count = 0;
    get(count);
    good_ = good_ && count <= left_.size();
    return good_ ? count : 0;
  }

  std::span<const std::byte> left_;
  bool good_ = true;
};

}  // namespace planetree::octree
