// SPDX-License-Identifier: MIT
#include "tb/scene/block_encoder.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>

#include "spec/error.h"
#include "spec/texture/tables.h"
#include "tb/scene/quality.h"

namespace deburr::tb {
namespace {

using spec::texture::Format;
using Rgb = std::array<int, 3>;
using Texels = std::array<Rgba8, 16>;  // texel (x, y) is entry 4 y + x
using Output = std::vector<std::uint8_t>;

constexpr int kNoError = std::numeric_limits<int>::max();
constexpr int kOpaque = 128;  // least alpha of a texel that is not a hole, in formats with one bit

int clamped(int value) { return std::clamp(value, 0, 255); }
int widened(int value, int bits) { return value << (8 - bits) | value >> (2 * bits - 8); }
// The code of `bits` whose widened value is nearest to numerator / denominator.
int narrowed(int numerator, int denominator, int bits) {
  const int most = (1 << bits) - 1;
  if (numerator <= 0) return 0;
  return std::min(most, (2 * numerator * most + 255 * denominator) / (510 * denominator));
}
int square(int value) { return value * value; }
int distance(const Rgb& a, const Rgba8& b) {
  return square(a[0] - b[0]) + square(a[1] - b[1]) + square(a[2] - b[2]);
}
void put(Output& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}
void put_big_endian(Output& out, std::uint64_t value) {
  for (int i = 7; i >= 0; --i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

// ---- BC colours ---------------------------------------------------------------------------------

constexpr std::array<int, 3> kBits = {5, 6, 5};

// Two end points in codes of 5, 6, 5 bits, and a selector per texel.
struct BcColours {
  std::array<Rgb, 2> end{};
  std::array<std::uint8_t, 16> selector{};
  int error = kNoError;
};

class BcColourEncoder {
 public:
  // `holes`: texels with alpha below kOpaque get selector 3, and the others one of three colours.
  BcColourEncoder(const Texels& texels, bool may_have_holes) : texels_(texels) {
    for (std::size_t i = 0; i < 16; ++i) {
      used_[i] = !may_have_holes || texels[i][3] >= kOpaque;
      number_ += used_[i] ? 1 : 0;
    }
    three_ = number_ < 16;
  }

  std::uint64_t block() {
    if (number_ == 0) return std::uint64_t{0xFFFFFFFF} << 32;  // c0 = c1: three colours
    fit_from(extremes());
    // In a block of nearly one colour a value between the end points is finer than an end point.
    if (spread_ <= kNearlyOne) {
      std::array<std::uint8_t, 16> between{};
      between.fill(2);
      keep_better(refitted(between, {mean_codes(), mean_codes()}, kWideSearch));
    }
    return packed();
  }

 private:
  static constexpr int kNearlyOne = 24, kSearch = 1, kWideSearch = 3, kRefits = 2;

  // Weight of the first end point in sixths, by selector.
  int weight_of(std::size_t selector) const {
    constexpr std::array<int, 4> kFour = {6, 0, 4, 2}, kThree = {6, 0, 3, 3};
    return (three_ ? kThree : kFour)[selector];
  }
  std::size_t selectors() const { return three_ ? 3 : 4; }
  int value_of(int a, int b, std::size_t selector) const {
    const int w = weight_of(selector);
    return (w * a + (6 - w) * b) / 6;
  }

  Rgb mean_codes() const {
    Rgb codes{};
    for (std::size_t c = 0; c < 3; ++c) {
      int sum = 0;
      for (std::size_t i = 0; i < 16; ++i) sum += used_[i] ? texels_[i][c] : 0;
      codes[c] = narrowed(sum, number_, kBits[c]);
    }
    return codes;
  }

  // The texels that are furthest apart along the principal axis.
  std::array<Rgb, 2> extremes() {
    Rgb sum{}, low = {255, 255, 255}, high{};
    for (std::size_t i = 0; i < 16; ++i)
      for (std::size_t c = 0; c < 3 && used_[i]; ++c) {
        sum[c] += texels_[i][c];
        low[c] = std::min<int>(low[c], texels_[i][c]);
        high[c] = std::max<int>(high[c], texels_[i][c]);
      }
    std::array<std::array<std::int64_t, 3>, 3> covariance{};
    for (std::size_t i = 0; i < 16; ++i) {
      if (!used_[i]) continue;
      Rgb d{};
      for (std::size_t c = 0; c < 3; ++c) d[c] = number_ * texels_[i][c] - sum[c];
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) covariance[r][c] += std::int64_t{d[r]} * d[c];
    }
    std::array<std::int64_t, 3> axis{};
    std::size_t widest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      spread_ = std::max(spread_, high[c] - low[c]);
      if (covariance[c][c] > covariance[widest][widest]) widest = c;
    }
    axis = covariance[widest];
    for (int step = 0; step < 4; ++step) {
      std::int64_t most = 1;
      for (const std::int64_t value : axis) most = std::max(most, std::abs(value));
      for (std::int64_t& value : axis) value = value * 1024 / most;
      std::array<std::int64_t, 3> next{};
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) next[r] += covariance[r][c] * axis[c];
      axis = next;
    }
    std::int64_t most = 1;
    for (const std::int64_t value : axis) most = std::max(most, std::abs(value));
    for (std::int64_t& value : axis) value = value * 1024 / most;
    std::size_t first = 16, last = 16;
    std::int64_t least = 0, largest = 0;
    for (std::size_t i = 0; i < 16; ++i) {
      if (!used_[i]) continue;
      std::int64_t along = 0;
      for (std::size_t c = 0; c < 3; ++c) along += axis[c] * texels_[i][c];
      if (first == 16 || along < least) first = i, least = along;
      if (last == 16 || along > largest) last = i, largest = along;
    }
    std::array<Rgb, 2> ends{};
    for (std::size_t c = 0; c < 3; ++c) {
      ends[0][c] = narrowed(texels_[last][c], 1, kBits[c]);
      ends[1][c] = narrowed(texels_[first][c], 1, kBits[c]);
    }
    return ends;
  }

  std::array<Rgb, 4> palette_of(const std::array<Rgb, 2>& ends) const {
    std::array<Rgb, 4> palette{};
    for (std::size_t s = 0; s < selectors(); ++s)
      for (std::size_t c = 0; c < 3; ++c)
        palette[s][c] = value_of(widened(ends[0][c], kBits[c]), widened(ends[1][c], kBits[c]), s);
    return palette;
  }

  BcColours assigned(const std::array<Rgb, 2>& ends) const {
    const std::array<Rgb, 4> palette = palette_of(ends);
    BcColours result{ends, {}, 0};
    for (std::size_t i = 0; i < 16; ++i) {
      if (!used_[i]) {
        result.selector[i] = 3;
        continue;
      }
      int least = kNoError;
      for (std::size_t s = 0; s < selectors(); ++s)
        if (const int error = distance(palette[s], texels_[i]); error < least) {
          least = error;
          result.selector[i] = static_cast<std::uint8_t>(s);
        }
      result.error += least;
    }
    return result;
  }

  // The end points that fit given selectors best: least squares, then a search around them with
  // the values that are decoded.
  BcColours refitted(const std::array<std::uint8_t, 16>& selector, std::array<Rgb, 2> ends,
                     int range) const {
    std::array<int, 4> number{};
    std::array<Rgb, 4> sum{};
    for (std::size_t i = 0; i < 16; ++i) {
      if (!used_[i]) continue;
      ++number[selector[i]];
      for (std::size_t c = 0; c < 3; ++c) sum[selector[i]][c] += texels_[i][c];
    }
    int aa = 0, ab = 0, bb = 0;  // sums of squares of the weights, in 1/36
    for (std::size_t s = 0; s < selectors(); ++s) {
      const int w = weight_of(s);
      aa += number[s] * w * w;
      ab += number[s] * w * (6 - w);
      bb += number[s] * (6 - w) * (6 - w);
    }
    const int determinant = aa * bb - ab * ab;
    for (std::size_t c = 0; c < 3; ++c) {
      if (determinant != 0) {
        int a = 0, b = 0;
        for (std::size_t s = 0; s < selectors(); ++s) {
          a += weight_of(s) * sum[s][c];
          b += (6 - weight_of(s)) * sum[s][c];
        }
        // Sums of at most 16 x 6 x 255, and of squares below 16 x 36.
        const std::int64_t first = std::int64_t{6} * (std::int64_t{a} * bb - std::int64_t{b} * ab),
                           second = std::int64_t{6} * (std::int64_t{b} * aa - std::int64_t{a} * ab);
        const auto code = [&](std::int64_t numerator) {
          return narrowed(
              static_cast<int>(std::clamp<std::int64_t>(16 * numerator / determinant, 0, 4080)), 16,
              kBits[c]);
        };
        ends[0][c] = code(first);
        ends[1][c] = code(second);
      }
      search(number, sum, c, ends, range);
    }
    return assigned(ends);
  }

  void search(const std::array<int, 4>& number, const std::array<Rgb, 4>& sum, std::size_t c,
              std::array<Rgb, 2>& ends, int range) const {
    const int most = (1 << kBits[c]) - 1;
    std::array<int, 2> best = {ends[0][c], ends[1][c]};
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    for (int p = std::max(0, ends[0][c] - range); p <= std::min(most, ends[0][c] + range); ++p)
      for (int q = std::max(0, ends[1][c] - range); q <= std::min(most, ends[1][c] + range); ++q) {
        std::int64_t error = 0;  // without the squares of the texels
        for (std::size_t s = 0; s < selectors(); ++s) {
          const int value = value_of(widened(p, kBits[c]), widened(q, kBits[c]), s);
          error += std::int64_t{number[s]} * value * value - std::int64_t{2} * value * sum[s][c];
        }
        if (error < least) least = error, best = {p, q};
      }
    ends[0][c] = best[0];
    ends[1][c] = best[1];
  }

  void fit_from(const std::array<Rgb, 2>& ends) {
    keep_better(assigned(ends));
    for (int i = 0; i < kRefits && best_.error > 0; ++i) {
      const int before = best_.error;
      keep_better(refitted(best_.selector, best_.end, kSearch));
      if (best_.error == before) break;
    }
  }
  void keep_better(const BcColours& other) {
    if (other.error < best_.error) best_ = other;
  }

  static unsigned code_of(const Rgb& end) {
    return static_cast<unsigned>(end[0] << 11 | end[1] << 5 | end[2]);
  }
  // c0 > c1 is four colours. With equal end points all colours but a hole are selector 0.
  std::uint64_t packed() const {
    std::uint64_t first = code_of(best_.end[0]), second = code_of(best_.end[1]);
    const bool swap = three_ ? first > second : first < second;
    if (swap) std::swap(first, second);
    std::uint64_t block = first | second << 16;
    for (std::size_t i = 0; i < 16; ++i) {
      unsigned s = best_.selector[i];
      if (first == second && used_[i]) s = 0;
      // The two end points, and the thirds: 0 and 1, 2 and 3.
      if (swap && !(three_ && s >= 2)) s ^= 1;
      block |= std::uint64_t{s} << (32 + 2 * i);
    }
    return block;
  }

  const Texels& texels_;
  std::array<bool, 16> used_{};
  int number_ = 0, spread_ = 0;
  bool three_ = false;
  BcColours best_;
};

// ---- BC values ----------------------------------------------------------------------------------

using Values = std::array<std::uint8_t, 16>;

// Selectors for end points a and b; replaces `block` if the error is below `least`.
void try_values(const Values& values, int a, int b, int& least, std::uint64_t& block) {
  std::array<int, 8> palette = {a, b, 0, 0, 0, 0, 0, 255};
  const int steps = a > b ? 7 : 5;
  for (int s = 2; s <= steps; ++s)
    palette[static_cast<std::size_t>(s)] = ((steps + 1 - s) * a + (s - 1) * b) / steps;
  int error = 0;
  std::uint64_t made = static_cast<std::uint64_t>(a) | static_cast<std::uint64_t>(b) << 8;
  for (std::size_t i = 0; i < 16; ++i) {
    int nearest = kNoError;
    std::uint64_t selector = 0;
    for (std::size_t s = 0; s < 8; ++s)
      if (const int each = square(palette[s] - values[i]); each < nearest)
        nearest = each, selector = s;
    error += nearest;
    made |= selector << (16 + 3 * i);
  }
  if (error < least) least = error, block = made;
}

std::uint64_t bc_values(const Values& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  int least = kNoError, inner_low = 255, inner_high = 0;
  std::uint64_t block = 0;
  try_values(values, *high, *low, least, block);
  // Six values between the others, with 0 and 255 as selectors of their own.
  for (const int value : values) {
    if (value == 0 || value == 255) continue;
    inner_low = std::min(inner_low, value);
    inner_high = std::max(inner_high, value);
  }
  if (least > 0) try_values(values, std::min(inner_low, inner_high), inner_high, least, block);
  return block;
}

// ---- ETC2 colours -------------------------------------------------------------------------------

// The sub-block of a texel in words of ETC2: x < 2, or y < 2 if flipped.
bool is_second(std::size_t i, bool flip) { return (flip ? i / 4 : i % 4) >= 2; }
// Bit of a texel's selector: texel (x, y) is 4 x + y.
std::size_t etc_index(std::size_t i) { return 4 * (i % 4) + i / 4; }

// Half of a block with a base colour, a table and selectors.
struct SubBlock {
  Rgb code{};
  int table = 0;
  std::uint64_t selectors = 0;  // in the places of the block
  int error = kNoError;
};

class EtcEncoder {
 public:
  EtcEncoder(const Texels& texels, bool one_bit_alpha) : texels_(texels), one_bit_(one_bit_alpha) {
    for (std::size_t i = 0; i < 16; ++i) {
      used_[i] = !one_bit_ || texels[i][3] >= kOpaque;
      holes_ = holes_ || !used_[i];
    }
  }

  std::uint64_t block() {
    for (const bool flip : {false, true}) {
      if (!one_bit_) try_individual(flip);
      try_differential(flip);
    }
    if (!holes_ && error_ > 0) try_planar();
    return block_;
  }

 private:
  static constexpr std::uint64_t kDifferential = std::uint64_t{1} << 33;

  void keep(std::uint64_t block, int error) {
    if (error < error_) error_ = error, block_ = block;
  }

  bool is_empty(bool flip, bool second) const {
    for (std::size_t i = 0; i < 16; ++i)
      if (is_second(i, flip) == second && used_[i]) return false;
    return true;
  }

  // Modifiers in order of their selectors; a hole has selector 2.
  std::array<int, 4> modifiers_of(int table) const {
    const auto& m = spec::texture::kEtcModifiers[static_cast<std::size_t>(table)];
    return {holes_ ? 0 : m[0], m[1], -m[0], -m[1]};
  }

  SubBlock assigned(bool flip, bool second, const Rgb& code, int bits, int table) const {
    const std::array<int, 4> modifiers = modifiers_of(table);
    std::array<Rgb, 4> palette{};
    for (std::size_t s = 0; s < 4; ++s)
      for (std::size_t c = 0; c < 3; ++c)
        palette[s][c] = clamped(widened(code[c], bits) + modifiers[s]);
    SubBlock result{code, table, 0, 0};
    for (std::size_t i = 0; i < 16; ++i) {
      if (is_second(i, flip) != second) continue;
      int least = used_[i] ? kNoError : 0;
      std::uint64_t selector = 2;
      for (std::size_t s = 0; s < 4 && used_[i]; ++s) {
        if (holes_ && s == 2) continue;
        if (const int error = distance(palette[s], texels_[i]); error < least)
          least = error, selector = s;
      }
      result.error += least;
      result.selectors |= (selector >> 1) << (16 + etc_index(i)) | (selector & 1) << etc_index(i);
    }
    return result;
  }

  // The table whose modifiers fit best, if nothing is clamped: a modifier m leaves the error
  // 3 m^2 - 2 m d, where d is the sum of the differences of R, G and B.
  int best_table(bool flip, bool second, const Rgb& code, int bits) const {
    int base = 0;
    for (std::size_t c = 0; c < 3; ++c) base += widened(code[c], bits);
    std::array<int, 8> away{};
    std::size_t number = 0;
    for (std::size_t i = 0; i < 16; ++i)
      if (is_second(i, flip) == second && used_[i])
        away[number++] = std::abs(texels_[i][0] + texels_[i][1] + texels_[i][2] - base);
    int best = 0, least = kNoError;
    for (int table = 0; table < 8; ++table) {
      const auto& m = spec::texture::kEtcModifiers[static_cast<std::size_t>(table)];
      const int small = holes_ ? 0 : m[0], large = m[1];
      int error = 0;
      for (std::size_t i = 0; i < number; ++i)
        error += std::min(small * (3 * small - 2 * away[i]), large * (3 * large - 2 * away[i]));
      if (error < least) least = error, best = table;
    }
    return best;
  }

  // Codes of the mean of a half, less the modifiers of a fit.
  Rgb mean_code(bool flip, bool second, int bits, const SubBlock* fit = nullptr) const {
    Rgb sum{};
    int number = 0;
    for (std::size_t i = 0; i < 16; ++i) {
      if (is_second(i, flip) != second || !used_[i]) continue;
      ++number;
      int modifier = 0;
      if (fit != nullptr) {
        const std::size_t s =
            (fit->selectors >> (16 + etc_index(i)) & 1) << 1 | (fit->selectors >> etc_index(i) & 1);
        modifier = modifiers_of(fit->table)[s];
      }
      for (std::size_t c = 0; c < 3; ++c) sum[c] += texels_[i][c] - modifier;
    }
    Rgb code{};
    for (std::size_t c = 0; c < 3 && number > 0; ++c) code[c] = narrowed(sum[c], number, bits);
    return code;
  }

  SubBlock fitted(bool flip, bool second, const Rgb& code, int bits) const {
    return assigned(flip, second, code, bits, best_table(flip, second, code, bits));
  }
  SubBlock half(bool flip, bool second, int bits) const {
    SubBlock best = fitted(flip, second, mean_code(flip, second, bits), bits);
    if (best.error == 0) return best;
    const Rgb again = mean_code(flip, second, bits, &best);
    if (again == best.code) return best;
    const SubBlock other = fitted(flip, second, again, bits);
    return other.error < best.error ? other : best;
  }

  static std::uint64_t tables_and_flip(const SubBlock& a, const SubBlock& b, bool flip) {
    return static_cast<std::uint64_t>(a.table) << 37 | static_cast<std::uint64_t>(b.table) << 34 |
           std::uint64_t{flip} << 32 | a.selectors | b.selectors;
  }

  void try_individual(bool flip) {
    const SubBlock a = half(flip, false, 4), b = half(flip, true, 4);
    std::uint64_t block = tables_and_flip(a, b, flip);
    for (std::size_t c = 0; c < 3; ++c)
      block |= static_cast<std::uint64_t>(a.code[c] << 4 | b.code[c]) << (56 - 8 * c);
    keep(block, a.error + b.error);
  }

  void try_differential(bool flip) {
    SubBlock a = half(flip, false, 5), b = half(flip, true, 5);
    if (is_empty(flip, false)) a.code = b.code;  // all texels of the first half are holes
    Rgb limited{};
    for (std::size_t c = 0; c < 3; ++c)
      limited[c] = std::clamp(b.code[c], std::max(0, a.code[c] - 4), std::min(31, a.code[c] + 3));
    if (limited != b.code) b = fitted(flip, true, limited, 5);
    std::uint64_t block = tables_and_flip(a, b, flip) | (holes_ ? 0 : kDifferential);
    for (std::size_t c = 0; c < 3; ++c)
      block |= static_cast<std::uint64_t>(a.code[c] << 3 | ((b.code[c] - a.code[c]) & 7))
               << (56 - 8 * c);
    keep(block, a.error + b.error);
  }

  // O, H and V from the least squares plane.
  void try_planar() {
    constexpr std::array<int, 3> kPlanarBits = {6, 7, 6};
    std::array<Rgb, 3> code{};  // of O, H, V
    int error = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      int sum = 0, across = 0, down = 0;
      for (std::size_t i = 0; i < 16; ++i) {
        const int value = texels_[i][c], x = static_cast<int>(i % 4), y = static_cast<int>(i / 4);
        sum += value;
        across += (2 * x - 3) * value;
        down += (2 * y - 3) * value;
      }
      const int origin = 5 * sum - 3 * (across + down);  // times 80
      const int bits = kPlanarBits[c];
      const std::array<int, 3> fit = {narrowed(origin, 80, bits),
                                      narrowed(origin + 8 * across, 80, bits),
                                      narrowed(origin + 8 * down, 80, bits)};
      // The codes next to them, since the three are rounded together.
      int least = kNoError;
      for (int n = 0; n < 27; ++n) {
        const std::array<int, 3> tried = {fit[0] + n % 3 - 1, fit[1] + n / 3 % 3 - 1,
                                          fit[2] + n / 9 - 1};
        if (std::any_of(tried.begin(), tried.end(),
                        [&](int each) { return each < 0 || each >= 1 << bits; }))
          continue;
        const int each = planar_error(c, tried, bits);
        if (each < least) {
          least = each;
          for (std::size_t p = 0; p < 3; ++p) code[p][c] = tried[p];
        }
      }
      error += least;
      if (error >= error_) return;
    }
    keep(planar(code), error);
  }

  int planar_error(std::size_t c, const std::array<int, 3>& codes, int bits) const {
    const int o = widened(codes[0], bits), h = widened(codes[1], bits), v = widened(codes[2], bits);
    int error = 0;
    for (std::size_t i = 0; i < 16; ++i) {
      const int x = static_cast<int>(i % 4), y = static_cast<int>(i / 4);
      error += square(clamped((x * (h - o) + y * (v - o) + 4 * o + 2) >> 2) - texels_[i][c]);
    }
    return error;
  }

  // R and G must not overflow, and B must: this is what the remaining bits are for.
  static std::uint64_t planar(const std::array<Rgb, 3>& code) {
    const auto part = [&](std::size_t point, std::size_t c, int high, int low) {
      return static_cast<std::uint64_t>(code[point][c] >> low) &
             ((std::uint64_t{1} << (high - low + 1)) - 1);
    };
    std::uint64_t block = kDifferential;
    block |= part(0, 0, 5, 0) << 57 | part(0, 1, 6, 6) << 56 | part(0, 1, 5, 0) << 49 |
             part(0, 2, 5, 5) << 48 | part(0, 2, 4, 3) << 43 | part(0, 2, 2, 0) << 39;
    block |= part(1, 0, 5, 1) << 34 | part(1, 0, 0, 0) << 32 | part(1, 1, 6, 0) << 25 |
             part(1, 2, 5, 0) << 19;
    block |= part(2, 0, 5, 0) << 13 | part(2, 1, 6, 0) << 6 | part(2, 2, 5, 0);
    const auto sum_of = [&](int low) {  // of the five bits and the signed three below them
      const int base = static_cast<int>(block >> (low + 3) & 31),
                step = static_cast<int>(block >> low & 7);
      return base + (step ^ 4) - 4;
    };
    if (sum_of(56) < 0) block |= std::uint64_t{1} << 63;
    if (sum_of(48) < 0) block |= std::uint64_t{1} << 55;
    const bool over = (block >> 43 & 3) + (block >> 40 & 3) >= 4;
    block |= over ? std::uint64_t{7} << 45 : std::uint64_t{1} << 42;
    return block;
  }

  const Texels& texels_;
  bool one_bit_, holes_ = false;
  std::array<bool, 16> used_{};
  std::uint64_t block_ = 0;
  int error_ = kNoError;
};

// ---- EAC alpha ----------------------------------------------------------------------------------

std::uint64_t eac_alpha(const Values& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  int least = kNoError;
  std::uint64_t block = 0;
  for (std::size_t table = 0; table < 16 && least > 0; ++table) {
    const auto& modifiers = spec::texture::kEacModifiers[table];
    const int span = modifiers[7] - modifiers[3];
    const int middle = (*high - *low + span / 2) / span;
    for (int m = std::max(1, middle - 1); m <= std::clamp(middle + 1, 1, 15); ++m) {
      const int base = clamped((*low - m * modifiers[3] + *high - m * modifiers[7] + 1) / 2);
      int error = 0;
      std::uint64_t made = static_cast<std::uint64_t>(base) << 56 |
                           static_cast<std::uint64_t>(m) << 52 | std::uint64_t{table} << 48;
      for (std::size_t i = 0; i < 16 && error < least; ++i) {
        int nearest = kNoError;
        std::uint64_t selector = 0;
        for (std::size_t s = 0; s < 8; ++s)
          if (const int each = square(clamped(base + m * modifiers[s]) - values[i]); each < nearest)
            nearest = each, selector = s;
        error += nearest;
        made |= selector << (45 - 3 * etc_index(i));
      }
      if (error < least) least = error, block = made;
    }
  }
  return block;
}

// ---- blocks -------------------------------------------------------------------------------------

Values channel(const Texels& texels, std::size_t c) {
  Values values{};
  for (std::size_t i = 0; i < 16; ++i) values[i] = texels[i][c];
  return values;
}
// As platform::encode_texel() for l8.
std::uint8_t grey_of(const Rgba8& texel) {
  return static_cast<std::uint8_t>((77 * texel[0] + 150 * texel[1] + 29 * texel[2] + 128) >> 8);
}
Values grey(const Texels& texels) {
  Values values{};
  std::transform(texels.begin(), texels.end(), values.begin(), grey_of);
  return values;
}

void encode(const Texels& texels, Format format, Output& out) {
  switch (format) {
    case Format::kBc1:
      return put(out, BcColourEncoder(texels, true).block(), 8);
    case Format::kBc3:
      put(out, bc_values(channel(texels, 3)), 8);
      return put(out, BcColourEncoder(texels, false).block(), 8);
    case Format::kBc4:
      return put(out, bc_values(grey(texels)), 8);
    case Format::kBc5:
      put(out, bc_values(channel(texels, 0)), 8);
      return put(out, bc_values(channel(texels, 1)), 8);
    case Format::kEtc2Rgb:
      return put_big_endian(out, EtcEncoder(texels, false).block());
    case Format::kEtc2RgbA1:
      return put_big_endian(out, EtcEncoder(texels, true).block());
    case Format::kEtc2Rgba8:
      put_big_endian(out, eac_alpha(channel(texels, 3)));
      return put_big_endian(out, EtcEncoder(texels, false).block());
    default:
      break;
  }
  DEBURR_CHECK(false, "the format has no blocks");
}

}  // namespace

std::vector<std::uint8_t> encode_blocks(const Image& level, Format format) {
  std::vector<std::uint8_t> blocks;
  const int columns = (level.width + 3) / 4, rows = (level.height + 3) / 4;
  blocks.reserve(spec::texture::kFormatBlockBytes[static_cast<std::size_t>(format)] *
                 static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  Texels texels{};
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      for (int i = 0; i < 16; ++i)
        texels[static_cast<std::size_t>(i)] =
            level.at(std::min(4 * column + i % 4, level.width - 1),
                     std::min(4 * row + i / 4, level.height - 1));
      encode(texels, format, blocks);
    }
  return blocks;
}

double block_psnr(const Image& image, const Image& decoded, Format format) {
  const std::size_t channels = format == Format::kBc4 ? 1 : format == Format::kBc5 ? 2 : 3;
  const bool one_bit = format == Format::kBc1 || format == Format::kEtc2RgbA1;
  std::uint64_t sum = 0, number = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (one_bit && decoded.pixels[i][3] == 0) continue;
    Rgba8 wanted = image.pixels[i];
    if (format == Format::kBc4) wanted[0] = grey_of(wanted);
    for (std::size_t c = 0; c < channels; ++c)
      sum += static_cast<std::uint64_t>(square(wanted[c] - decoded.pixels[i][c]));
    number += channels;
  }
  return psnr_from_mse(number == 0 ? 0 : static_cast<double>(sum) / static_cast<double>(number));
}

}  // namespace deburr::tb
