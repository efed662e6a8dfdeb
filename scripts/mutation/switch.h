// SPDX-License-Identifier: MIT
// The switches of mutants. A program compiled with schemata (mutants.py) holds every mutant, each
// disabled until the environment names it. Included before everything else, so that the switches
// are read before any other initialisation.
#ifndef DEBURR_SCRIPTS_MUTATION_SWITCH_H
#define DEBURR_SCRIPTS_MUTATION_SWITCH_H

#include <fcntl.h>
#include <sys/mman.h>

#include <concepts>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <type_traits>

namespace deburr_mutant {

inline constexpr unsigned kMost = 1U << 16;
// The number of a mutant compiled by itself, which is always enabled.
inline constexpr unsigned kAlone = kMost;
enum State : unsigned char { kOff, kOn, kAsked };
enum Answer : unsigned char { kReached = 1, kNoSuchOperator = 2 };

// DEBURR_MUTANT=n enables one mutant. With DEBURR_MUTANTS_REACHED=file all are disabled, and the
// file (kMost bytes) records which of them ran.
struct Switches {
  unsigned char state[kMost];
  unsigned char* reached;

  Switches() {
    if (const char* number = std::getenv("DEBURR_MUTANT")) {
      state[std::strtoul(number, nullptr, 10) % kMost] = kOn;
    }
    if (const char* path = std::getenv("DEBURR_MUTANTS_REACHED")) {
      const int file = ::open(path, O_RDWR);
      void* bytes = ::mmap(nullptr, kMost, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
      if (bytes == MAP_FAILED) std::abort();
      reached = static_cast<unsigned char*>(bytes);
      std::memset(state, kAsked, kMost);
    }
  }
};
inline Switches switches;

[[gnu::noinline, gnu::cold]] inline bool answer(unsigned n, Answer with) {
  if (switches.state[n] == kOn) return true;
  switches.reached[n] |= with;
  if (with == kReached) switches.state[n] = kOff;
  return false;
}

// Returns false in constant expressions. A mutant inside a constant expression needs its own build
// instead.
template <unsigned n>
[[gnu::always_inline]] constexpr bool on() {
  if constexpr (n == kAlone) {
    return true;
  } else {
    if (std::is_constant_evaluated()) return false;
    return switches.state[n] != kOff && answer(n, kReached);
  }
}

template <unsigned n>
[[gnu::always_inline]] constexpr void no_such_operator() {
  static_assert(n != kAlone);
  if (std::is_constant_evaluated()) return;
  if (switches.state[n] != kOff) answer(n, kNoSuchOperator);
}

// n adds one, n + 1 subtracts one.
template <unsigned n, class T>
[[gnu::always_inline]] constexpr T constant(T value) {
  if (on<n>()) return value + 1;
  if (value != 0 && on<n + 1>()) return value - 1;
  return value;
}

// Exchanges std::min and std::max.
template <unsigned n>
struct Extreme {
  template <class T>
  [[gnu::always_inline]] static constexpr const T& min(const T& a, const T& b) {
    return (b < a) != on<n>() ? b : a;
  }
  template <class T>
  [[gnu::always_inline]] static constexpr const T& max(const T& a, const T& b) {
    return (a < b) != on<n>() ? b : a;
  }
  template <class T>
  static constexpr T min(std::initializer_list<T> all) {
    const T* found = all.begin();
    for (const T& each : all) found = &min(*found, each);
    return *found;
  }
  template <class T>
  static constexpr T max(std::initializer_list<T> all) {
    const T* found = all.begin();
    for (const T& each : all) found = &max(*found, each);
    return *found;
  }
};

// `kept(a) = kept(b) = 0` is `a = b = 0`, or keeps the old value of one of them.
template <unsigned n, class T>
struct Kept {
  T& target;
  template <class U = T>
  [[gnu::always_inline]] constexpr T operator=(U&& value) const {
    if (on<n>()) return static_cast<T>(value);
    return target = static_cast<U&&>(value);
  }
};
template <unsigned n, class T>
[[gnu::always_inline]] constexpr Kept<n, T> kept(T& target) {
  return {target};
}

// `left infix Name<n>{} infix right` is `left was right`, with the same precedence.
#define DEBURR_MUTANT_OPERATOR(Name, infix, was, becomes)                                         \
  template <unsigned n>                                                                           \
  struct Name {};                                                                                 \
  template <unsigned n, class L>                                                                  \
  struct Left##Name {                                                                             \
    const L& value;                                                                               \
  };                                                                                              \
  template <unsigned n, class L>                                                                  \
  [[gnu::always_inline]] constexpr Left##Name<n, L> operator infix(const L& left, Name<n>) {      \
    return {left};                                                                                \
  }                                                                                               \
  template <unsigned n, class L, class R>                                                         \
  [[gnu::always_inline]] constexpr auto operator infix(Left##Name<n, L> left, const R& right)     \
      ->decltype(left.value was right) {                                                          \
    if constexpr (requires {                                                                      \
                    { left.value becomes right } -> std::same_as<decltype(left.value was right)>; \
                  }) {                                                                            \
      if (on<n>()) return left.value becomes right;                                               \
    } else {                                                                                      \
      no_such_operator<n>();                                                                      \
    }                                                                                             \
    return left.value was right;                                                                  \
  }
DEBURR_MUTANT_OPERATOR(Less, >=, <, <=)
DEBURR_MUTANT_OPERATOR(LessEqual, >=, <=, <)
DEBURR_MUTANT_OPERATOR(Greater, >=, >, >=)
DEBURR_MUTANT_OPERATOR(GreaterEqual, >=, >=, >)
DEBURR_MUTANT_OPERATOR(Equal, ==, ==, !=)
DEBURR_MUTANT_OPERATOR(NotEqual, ==, !=, ==)
DEBURR_MUTANT_OPERATOR(Plus, +, +, -)
DEBURR_MUTANT_OPERATOR(Minus, -, -, +)
DEBURR_MUTANT_OPERATOR(ShiftLeft, <<, <<, >>)
DEBURR_MUTANT_OPERATOR(ShiftRight, <<, >>, <<)
DEBURR_MUTANT_OPERATOR(BitAnd, &, &, |)
DEBURR_MUTANT_OPERATOR(BitOr, |, |, &)
DEBURR_MUTANT_OPERATOR(BitXor, ^, ^, &)
#undef DEBURR_MUTANT_OPERATOR

// `left infix Name<n>{} infix right`, from the right.
#define DEBURR_MUTANT_ASSIGNMENT(Name, was, becomes)                                         \
  template <unsigned n>                                                                      \
  struct Name {};                                                                            \
  template <unsigned n, class R>                                                             \
  struct Right##Name {                                                                       \
    const R& value;                                                                          \
  };                                                                                         \
  template <unsigned n, class R>                                                             \
  [[gnu::always_inline]] constexpr Right##Name<n, R> operator was(Name<n>, const R& right) { \
    return {right};                                                                          \
  }                                                                                          \
  template <unsigned n, class L, class R>                                                    \
  [[gnu::always_inline]] constexpr L& operator was(L& left, Right##Name<n, R> right) {       \
    if constexpr (requires { left becomes right.value; }) {                                  \
      if (on<n>()) {                                                                         \
        left becomes right.value;                                                            \
        return left;                                                                         \
      }                                                                                      \
    } else {                                                                                 \
      no_such_operator<n>();                                                                 \
    }                                                                                        \
    left was right.value;                                                                    \
    return left;                                                                             \
  }
DEBURR_MUTANT_ASSIGNMENT(Add, +=, -=)
DEBURR_MUTANT_ASSIGNMENT(Subtract, -=, +=)
DEBURR_MUTANT_ASSIGNMENT(ShiftLeftBy, <<=, >>=)
DEBURR_MUTANT_ASSIGNMENT(ShiftRightBy, >>=, <<=)
DEBURR_MUTANT_ASSIGNMENT(BitAndWith, &=, |=)
DEBURR_MUTANT_ASSIGNMENT(BitOrWith, |=, &=)
DEBURR_MUTANT_ASSIGNMENT(BitXorWith, ^=, &=)
#undef DEBURR_MUTANT_ASSIGNMENT

}  // namespace deburr_mutant

#endif  // DEBURR_SCRIPTS_MUTATION_SWITCH_H
