// SPDX-License-Identifier: MIT
// The field list of a payload: names, widths, formats. Generates the bit widths of links and FIFOs,
// traces, faults and mismatch messages per field, poison, and the types of a hardware description.
//
// A payload lists its fields in a member template, which does not depend on this header:
//
//   struct BeatToken {
//     Slot slot;                              // has its own field list
//     std::array<Rgba8, kMaxLanes> pixel;     // Rgba8 is std::array<std::uint8_t, 4>
//     std::uint8_t edges;                     // bit k: lane k
//     bool last;
//     template <class Self, class Visit>
//     static constexpr void fields(Self& self, Visit&& visit) {
//       visit("slot", self.slot);
//       visit.lanes("pixel", self.pixel, 8, "U0.8", "rgba");
//       visit.lane_bits("edges", self.edges, kMaxLanes);
//       visit("last", self.last);
//     }
//   };
//
//   visit(name, member, bits, format)    An integer, an enumeration, or a (nested) array of them.
//                                        An optional last argument gives letters for the innermost
//                                        index (pixel.0.r); otherwise elements are numbered.
//   visit(name, member)                  A bool, a payload, or an array of payloads.
//   visit.lanes(...)                     The first index is the lane; only built lanes count.
//   visit.lane_bits(name, member, most)  One bit per built lane.
//
// A PayloadShape, given with the link, narrows widths by parameters (a cache address).
//
// Bit 0 of a payload is bit 0 of its first field. An integer without a listed width has the width
// of its type, a bool one bit. An enumeration is unsigned. Checked: the elements of an array have
// equal shapes, names are unique, a width matches its format (Ua.b, Sa.b), no bit of the C++ type
// is listed twice.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

namespace deburr::rtl {

// The part of a payload that is built.
struct PayloadShape {
  std::uint32_t lanes = ~std::uint32_t{0};  // fewer than the per-lane arrays hold
  // Fields with fewer bits than listed, by the name of a field or of its container; 0: omitted.
  std::vector<std::pair<std::string, std::uint32_t>> widths = {};
  // Arrays of which only the first elements are built, by name.
  std::vector<std::pair<std::string, std::uint32_t>> counts = {};
  // An array of payloads of which only the first is built, as fields of the array's container.
  std::string single = {};
};

// The bits of one field and its location in the C++ type.
struct Field {
  std::string name;
  std::uint32_t bits = 0;
  std::string format;
  bool is_signed = false;
  std::uint32_t offset = 0, bytes = 0;  // in the C++ type
  std::uint32_t first_bit = 0;          // in the payload

  std::uint64_t mask() const {
    return bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  }
  // The bits of the field, without sign extension.
  std::uint64_t get(const std::byte* payload) const;
  void set(std::byte* payload, std::uint64_t value) const;
  // True if the C++ value fits the width.
  bool fits(const std::byte* payload) const;
  // A decimal number, signed if the field is.
  std::string text(const std::byte* payload) const;
};

// A payload as a tree of declarations for a hardware description.
struct PayloadNode {
  enum class Kind { kField, kArray, kStruct };
  Kind kind = Kind::kField;
  std::string name;
  std::string type;  // kStruct: name of its typedef
  Field field;       // kField
  std::vector<PayloadNode> children;
};

namespace detail {

template <class T>
struct IsArray : std::false_type {};
template <class T, std::size_t N>
struct IsArray<std::array<T, N>> : std::true_type {};

// Number of leaf elements of a nested array.
template <class T>
constexpr std::uint32_t leaves() {
  if constexpr (IsArray<T>::value)
    return static_cast<std::uint32_t>(std::tuple_size_v<T>) * leaves<typename T::value_type>();
  else
    return 1;
}

struct AnyVisit {
  template <class... Arguments>
  constexpr void operator()(Arguments&&...) const {}
  template <class... Arguments>
  constexpr void lanes(Arguments&&...) const {}
  template <class... Arguments>
  constexpr void lane_bits(Arguments&&...) const {}
};

}  // namespace detail

template <class T>
concept HasFields = requires(const T& payload, detail::AnyVisit visit) {
  T::fields(payload, visit);
};

namespace detail {

template <class T>
constexpr std::uint32_t payload_bits_of();

// Counts members and bits at compile time; a width that exceeds the C++ type is not a constant
// expression and so does not compile.
struct Measure {
  std::uint32_t bits = 0, members = 0;

  template <class M>
  constexpr void operator()(std::string_view, const M&, std::uint32_t field_bits,
                            std::string_view = {}, std::string_view letters = {}) {
    check(fits<M>(field_bits) && (letters.empty() || letters.size() == innermost<M>()));
    bits += leaves<M>() * field_bits;
    ++members;
  }
  template <class M>
  constexpr void operator()(std::string_view, const M&) {
    bits += payload_bits_of<M>();
    ++members;
  }
  template <class M, class... Rest>
  constexpr void lanes(std::string_view name, const M& member, Rest... rest) {
    static_assert(IsArray<M>::value, "the first index is the lane");
    (*this)(name, member, rest...);
  }
  template <class M>
  constexpr void lane_bits(std::string_view, const M&, std::uint32_t most) {
    check(fits<M>(most));
    bits += most;
    ++members;
  }

 private:
  template <class M>
  static constexpr std::size_t innermost() {
    if constexpr (IsArray<M>::value) {
      if constexpr (IsArray<typename M::value_type>::value)
        return innermost<typename M::value_type>();
      else
        return std::tuple_size_v<M>;
    } else {
      return 0;
    }
  }
  template <class M>
  static constexpr bool fits(std::uint32_t field_bits) {
    if constexpr (IsArray<M>::value)
      return fits<typename M::value_type>(field_bits);
    else if constexpr (std::is_same_v<M, bool>)
      return field_bits == 1;
    else
      return (std::is_integral_v<M> || std::is_enum_v<M>)&&field_bits >= 1 &&
             field_bits <= sizeof(M) * 8;
  }
  static constexpr void check(bool ok) {
    if (!ok) throw "a field is wider than its C++ type, or the number of its letters is wrong";
  }
};

template <HasFields T>
constexpr Measure measure() {
  Measure result;
  const T payload{};
  T::fields(payload, result);
  return result;
}

template <class T>
constexpr std::uint32_t payload_bits_of() {
  if constexpr (HasFields<T>)
    return measure<T>().bits;
  else if constexpr (IsArray<T>::value)
    return static_cast<std::uint32_t>(std::tuple_size_v<T>) *
           payload_bits_of<typename T::value_type>();
  else if constexpr (std::is_same_v<T, bool>)
    return 1;
  else {
    static_assert(std::is_integral_v<T> || std::is_enum_v<T>, "a payload must list its fields");
    return static_cast<std::uint32_t>(sizeof(T) * 8);
  }
}

// Number of members of an aggregate: the longest list of initialisers that it accepts.
struct AnyValue {
  template <class T>
  constexpr operator T() const;
};
template <class T, class... Values>
constexpr std::uint32_t members() {
  if constexpr (requires { T{Values{}..., AnyValue{}}; })
    return members<T, Values..., AnyValue>();
  else
    return static_cast<std::uint32_t>(sizeof...(Values));
}

// Builds the node of a member at run time. Runs once per link, so it is kept out of line and cold:
// unrolled into each constructor it took a third of an engine's code.
class PayloadBuilder {
 public:
  PayloadBuilder(const PayloadShape& shape, const void* payload)
      : shape_(shape), payload_(static_cast<const std::byte*>(payload)) {}

  template <class T>
  [[gnu::cold]] PayloadNode root(const T& payload) {
    if constexpr (HasFields<T>) {
      PayloadNode node = structure("", payload);
      check_single();
      return node;
    } else {
      static_assert(std::is_integral_v<T> || std::is_enum_v<T>, "a payload must list its fields");
      return field("value", payload, payload_bits_of<T>(), {});
    }
  }

  // --- The visitor ---
  template <class M>
  [[gnu::cold]] void operator()(std::string_view name, const M& member, std::uint32_t bits,
                                std::string_view format = {}, std::string_view letters = {}) {
    add(leaf(std::string(name), member, bits, format, letters, kAll));
  }
  template <class M>
  [[gnu::cold]] void operator()(std::string_view name, const M& member) {
    if constexpr (IsArray<M>::value)
      if constexpr (HasFields<typename M::value_type>)
        if (!shape_.single.empty() && path_ + std::string(name) == shape_.single) {
          has_single_ = true;
          M::value_type::fields(member[0], *this);
          return;
        }
    add(part(std::string(name), member, kAll));
  }
  template <class M>
  [[gnu::cold]] void lanes(std::string_view name, const M& member, std::uint32_t bits,
                           std::string_view format = {}, std::string_view letters = {}) {
    add(leaf(std::string(name), member, bits, format, letters, shape_.lanes));
  }
  template <class M>
  [[gnu::cold]] void lanes(std::string_view name, const M& member) {
    add(part(std::string(name), member, shape_.lanes));
  }
  template <class M>
  [[gnu::cold]] void lane_bits(std::string_view name, const M& member, std::uint32_t most) {
    add(field(std::string(name), member,
              static_cast<std::uint32_t>(count(path_ + std::string(name), shape_.lanes, most)),
              "one bit per lane"));
  }

 private:
  static constexpr std::uint32_t kAll = ~std::uint32_t{0};

  void add(PayloadNode node) { into_->children.push_back(std::move(node)); }
  template <class M>
  [[gnu::cold]] PayloadNode leaf(std::string name, const M& member, std::uint32_t bits,
                                 std::string_view format, std::string_view letters,
                                 std::size_t limit) {
    if constexpr (IsArray<M>::value) {
      constexpr bool kInnermost = !IsArray<typename M::value_type>::value;
      PayloadNode node = array(name);
      limit = count(path_ + name, limit, member.size());
      const std::string outer = std::exchange(path_, path_ + name + ".");
      for (std::size_t i = 0; i < limit; ++i)
        node.children.push_back(
            leaf(kInnermost && !letters.empty() ? std::string(1, letters[i]) : std::to_string(i),
                 member[i], bits, format, letters, kAll));
      path_ = outer;
      return node;
    } else {
      return field(std::move(name), member, bits, format);
    }
  }
  template <class M>
  [[gnu::cold]] PayloadNode part(std::string name, const M& member, std::size_t limit) {
    if constexpr (IsArray<M>::value) {
      PayloadNode node = array(name);
      limit = count(path_ + name, limit, member.size());
      const std::string outer = std::exchange(path_, path_ + name + ".");
      for (std::size_t i = 0; i < limit; ++i)
        node.children.push_back(part(std::to_string(i), member[i], kAll));
      path_ = outer;
      return node;
    } else if constexpr (HasFields<M>) {
      return structure(name, member);
    } else {
      static_assert(std::is_integral_v<M> || std::is_enum_v<M>,
                    "a field is an integer, an enumeration, an array or has fields of its own");
      return field(std::move(name), member, payload_bits_of<M>(), {});
    }
  }
  template <class T>
  [[gnu::cold]] PayloadNode structure(const std::string& name, const T& payload) {
    constexpr Measure kListed = measure<T>();
    if constexpr (std::is_aggregate_v<T>)
      static_assert(members<T>() == kListed.members, "a member is missing in the list");
    PayloadNode node;
    node.kind = PayloadNode::Kind::kStruct;
    node.type = type_name(typeid(T));
    node.name = name;
    const std::string outer = std::exchange(path_, name.empty() ? path_ : path_ + name + ".");
    PayloadNode* const around = std::exchange(into_, &node);
    T::fields(payload, *this);
    into_ = around;
    path_ = outer;
    return node;
  }
  template <class M>
  [[gnu::cold]] PayloadNode field(std::string name, const M& member, std::uint32_t bits,
                                  std::string_view format) {
    static_assert(std::is_integral_v<M> || std::is_enum_v<M>);
    return field(std::move(name), reinterpret_cast<const std::byte*>(&member) - payload_, sizeof(M),
                 bits, format, std::is_signed_v<M>);
  }
  PayloadNode field(std::string name, std::ptrdiff_t offset, std::size_t size, std::uint32_t bits,
                    std::string_view format, bool is_signed) const;
  static PayloadNode array(const std::string& name);
  void check_single() const;
  // Number of array elements that are built.
  std::size_t count(const std::string& name, std::size_t limit, std::size_t listed) const;
  static std::string type_name(const std::type_info& type);

  const PayloadShape& shape_;
  const std::byte* payload_;
  std::string path_;  // of the element being built
  PayloadNode* into_ = nullptr;
  bool has_single_ = false;
};

}  // namespace detail

// Bits of the complete payload, as listed.
template <class T>
inline constexpr std::uint32_t kPayloadBits = detail::payload_bits_of<T>();

// The description of a payload at run time.
class Payload {
 public:
  // One bit of a field.
  struct Bit {
    const Field* field;
    std::uint32_t bit;
  };

  template <class T>
  [[gnu::cold]] static Payload of(const PayloadShape& shape = {}) {
    const T payload{};
    return Payload(detail::PayloadBuilder(shape, &payload).root(payload), shape);
  }

  std::uint32_t bits() const { return bits_; }
  const std::vector<Field>& fields() const { return fields_; }
  const PayloadNode& node() const { return node_; }
  const Field* find(std::string_view field) const;  // nullptr if unknown
  // Accepts "pixel.0.r" (its bit 0), "pixel.0.r.7" or the number of a bit of the payload.
  // ConfigError with the available names otherwise.
  Bit bit(const std::string& text) const;

  void flip(std::byte* payload, Bit bit) const;
  // Fills every field with noise from the seed `pattern` and the field's number. CheckFailed for a
  // type without a field list, whose bytes may be anything.
  void fill(std::byte* payload, std::uint64_t pattern) const;
  // The first field whose C++ value exceeds its listed width; nullptr if all fit.
  const Field* misfit(const std::byte* payload) const;
  // "slot.row=3 last=1"
  std::string text(const std::byte* payload) const;
  // The fields that differ, as name=expected/got; empty if none does.
  std::string difference(const std::byte* expected, const std::byte* got) const;

 private:
  Payload(PayloadNode node, const PayloadShape& shape);
  void collect(PayloadNode& node);
  void check_fields() const;
  void check_shape(const PayloadShape& shape) const;

  PayloadNode node_;
  std::vector<Field> fields_;
  std::vector<std::string> left_out_;  // names
  std::uint32_t bits_ = 0;
};

// The same texts for a value outside a link.
template <class T>
std::string payload_text(const T& value) {
  return Payload::of<T>().text(reinterpret_cast<const std::byte*>(&value));
}
template <class T>
std::string payload_difference(const T& expected, const T& got) {
  return Payload::of<T>().difference(reinterpret_cast<const std::byte*>(&expected),
                                     reinterpret_cast<const std::byte*>(&got));
}

// A SystemVerilog package with a packed struct for each payload and for its members. Fields are
// declared from the most significant one down, so bit n of a struct is bit n of the payload. A
// payload that is an integer becomes u16_t or s16_t. Reserved words get a trailing underscore.
std::string payload_package(const std::string& name, std::span<const Payload* const> payloads);

}  // namespace deburr::rtl
