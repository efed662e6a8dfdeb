// SPDX-License-Identifier: MIT
// One description of a unit for both kinds of builds: at width 1 its links carry one token per
// cycle, above groups of them (docs/reference/texture/width.md).
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

#include "rtl_model/fabric/payload.h"
#include "rtl_model/texture/tokens.h"

namespace deburr::rtl::texture {

struct Narrow {
  template <class Token>
  using Fragments = Token;
  template <class Token>
  using Requests = Token;
  using TexelQuads = TexelQuadToken;
  static constexpr std::size_t kMost = 1;  // tokens per cycle
};
struct Wide {
  template <class Token>
  using Fragments = FragmentGroup<Token>;
  template <class Token>
  using Requests = RequestGroup<Token>;
  using TexelQuads = TexelQuadGroup;
  static constexpr std::size_t kMost = kMostInGroup;
};
// The unit of a width, of both that there are.
template <class Width, class OfNarrow, class OfWide>
using Built = std::conditional_t<std::is_same_v<Width, Narrow>, OfNarrow, OfWide>;

// A token is a group of one.
template <class Token>
concept IsGroup = requires(Token& token) {
  token.count;
  token.at;
};
template <class Token>
constexpr std::size_t count_of(const Token& group) {
  if constexpr (IsGroup<Token>)
    return group.count;
  else
    return 1;
}
template <class Token>
constexpr void set_count(Token& group, std::size_t count) {
  if constexpr (IsGroup<Token>) group.count = static_cast<std::uint8_t>(count);
}
template <class Token>
constexpr auto& nth(Token& group, std::size_t i) {
  if constexpr (IsGroup<std::remove_const_t<Token>>)
    return group.at[i];
  else
    return group;
}
// Computes each token of a group from the one at the same place.
template <class From, class To, class One>
constexpr void each(const From& from, To& to, const One& one) {
  set_count(to, count_of(from));
  for (std::size_t i = 0; i < count_of(from); ++i) one(nth(from, i), nth(to, i));
}

// Up to kMost values between two stages, in order.
template <class Value, std::size_t kMost>
struct Some {
  std::uint8_t count = 0;
  std::array<Value, kMost> at{};
  bool empty() const { return count == 0; }
  Value& add() {
    if constexpr (kMost == 1) {
      count = 1;
      return at[0];
    }
    return at[count++];
  }
  // Removes all of them and calls use(value, number).
  template <class Use>
  void take(const Use& use) {
    const std::size_t held = count;
    count = 0;
    for (std::size_t i = 0; i < kMost && i < held; ++i) use(at[i], i);
  }
};

// "sample" for the first token of a group, "sample_1" for the next; with a dot always numbered.
inline std::string numbered(const char* name, std::size_t number, const char* separator = "_") {
  std::string text = name;
  if (number != 0 || *separator == '.') text.append(separator).append(std::to_string(number));
  return text;
}

// Bits of a link with groups of at most `most` tokens, each with the fields of `shape`.
inline PayloadShape links_of_groups(std::int32_t most, const PayloadShape& shape = {}) {
  const auto tokens = static_cast<std::uint32_t>(most);
  PayloadShape group = {
      .widths = {{"count", most == 1 ? 0 : static_cast<std::uint32_t>(std::bit_width(tokens))}},
      .counts = {{"at", tokens}}};
  for (std::uint32_t i = 0; i < tokens; ++i)
    for (const auto& [field, bits] : shape.widths)
      group.widths.emplace_back(numbered("at", i, ".").append(".").append(field), bits);
  return group;
}
// Links of fragments with the fields of `shape`, and of requests, in both kinds of builds.
// `partial` is built if groups have more than one fragment.
template <class Width>
PayloadShape fragment_links(const spec::texture::Build& p, const PayloadShape& shape) {
  return std::is_same_v<Width, Narrow> ? shape : links_of_groups(p.fragments, shape);
}
template <class Width>
PayloadShape request_links(const spec::texture::Build& p, const PayloadShape& of_request) {
  if (std::is_same_v<Width, Narrow>) return of_request;
  PayloadShape shape = links_of_groups(p.width, of_request);
  shape.widths.emplace_back("partial", p.fragments == 1 ? 0 : static_cast<std::uint32_t>(p.width));
  return shape;
}

}  // namespace deburr::rtl::texture
