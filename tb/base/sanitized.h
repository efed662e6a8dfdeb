// SPDX-License-Identifier: MIT
// Whether AddressSanitizer is there, which GCC and clang say in different ways.
#pragma once

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

}  // namespace deburr::tb
