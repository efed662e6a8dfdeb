// SPDX-License-Identifier: MIT
// Whether AddressSanitizer is enabled; GCC and Clang report it differently.
#pragma once

#include <cstddef>
#include <vector>

namespace deburr::tb {

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define DEBURR_HAS_ADDRESS_SANITIZER
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define DEBURR_HAS_ADDRESS_SANITIZER
#endif
#ifdef DEBURR_HAS_ADDRESS_SANITIZER
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

// All elements. Sanitized builds are ten times slower and look for other faults, so they take every
// third.
template <class Range>
auto third_if_sanitized(const Range& all) {
  std::vector<typename Range::value_type> some;
  for (std::size_t i = 0; i < all.size(); i += kSanitized ? 3 : 1) some.push_back(all[i]);
  return some;
}

}  // namespace deburr::tb
