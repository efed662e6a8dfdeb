// SPDX-License-Identifier: MIT
#include "studies/training/weight_trainer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "spec/error.h"
#include "spec/morphological/tables.h"
#include "tb/base/fnv.h"
#include "tb/base/random.h"
#include "tb/scene/exact_math.h"

namespace deburr::studies::training {
namespace {

using golden::morphological::WeightIndices;
using golden::morphological::WeightTables;

constexpr std::size_t kA = 1024, kB = 640, kAll = kA + 2 * kB;
constexpr double kUnit = 16;  // S3.4
constexpr double kMost = 0.5;

using Weights = std::vector<double>;  // A, B, C, as real-valued sums

double sigmoid(double z) { return 1 / (1 + tb::exponential(-z)); }

// Linear light to code as a real-valued function, and its slope.
class Encoding {
 public:
  Encoding() {
    for (std::size_t i = 0; i < code_.size(); ++i) {
      const double l = static_cast<double>(i) / kSteps;
      code_[i] = 255 * (l <= 0.0031308 ? 12.92 * l : 1.055 * tb::power(l, 1 / 2.4) - 0.055);
    }
  }
  struct Point {
    double code, slope;
  };
  Point at(double linear) const {
    const double place = std::clamp(linear, 0.0, 1.0) * kSteps;
    const auto i = std::min(static_cast<std::size_t>(place), static_cast<std::size_t>(kSteps) - 1);
    const double step = code_[i + 1] - code_[i];
    return {code_[i] + (place - static_cast<double>(i)) * step, step * kSteps};
  }

 private:
  static constexpr int kSteps = 4096;
  std::array<double, kSteps + 1> code_{};
};

double linear(std::uint8_t code) { return spec::morphological::kLinear12FromSrgb[code] / 4095.0; }

// The error of a pixel and its gradient.
class Pixel {
 public:
  Pixel(const Encoding& encoding, const Recipe& recipe) : encoding_(encoding), recipe_(recipe) {}

  // Adds `factor` times the gradient if `gradient` is given.
  double operator()(const WeightSample& s, const Weights& weights, double factor,
                    Weights* gradient) const {
    std::array<double, 4> weight{}, slope{}, by_weight{};
    for (std::size_t i = 0; i < 4; ++i) {
      if (s.source[i] == Source::kLine) weight[i] = s.weight[i] / 256.0;
      if (s.source[i] != Source::kLearned) continue;
      const WeightIndices& at = s.indices[i];
      const double v =
          sigmoid(weights[at.codes] + weights[kA + at.near] + weights[kA + kB + at.far]);
      weight[i] = std::min(v, kMost);
      slope[i] = v < kMost ? v * (1 - v) : 0;
    }
    const double up_down = weight[0] + weight[1], left_right = weight[2] + weight[3];
    double chosen;  // fraction of the vertical pair
    bool soft = false;
    if (up_down == 0 || left_right == 0) {
      chosen = left_right == 0 ? 1 : 0;
    } else if (s.longer != 0) {
      chosen = s.longer > 0 ? 1 : 0;
    } else {
      chosen = sigmoid(recipe_.axis_slope * (up_down - left_right));
      soft = true;
    }
    std::array<double, 2> error{};
    for (std::size_t pair = 0; pair < 2; ++pair) {
      const double amount = pair == 0 ? chosen : 1 - chosen;
      if (amount == 0) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const double own = linear(s.own[c]);
        std::array<double, 2> difference{};
        double value = own;
        for (std::size_t k = 0; k < 2; ++k) {
          const std::size_t i = 2 * pair + k;
          if (s.source[i] == Source::kNone) continue;
          difference[k] = linear(s.neighbour[i][c]) - own;
          value += weight[i] * difference[k];
        }
        const Encoding::Point point = encoding_.at(value);
        const double off = point.code - s.reference[c];
        error[pair] += off * off;
        for (std::size_t k = 0; k < 2; ++k)
          by_weight[2 * pair + k] += amount * 2 * off * point.slope * difference[k];
      }
    }
    const double all = chosen * error[0] + (1 - chosen) * error[1];
    if (gradient == nullptr) return all;
    if (soft) {
      const double turn = recipe_.axis_slope * chosen * (1 - chosen) * (error[0] - error[1]);
      by_weight[0] += turn;
      by_weight[1] += turn;
      by_weight[2] -= turn;
      by_weight[3] -= turn;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      if (s.source[i] != Source::kLearned) continue;
      const double g = factor * by_weight[i] * slope[i];
      (*gradient)[s.indices[i].codes] += g;
      (*gradient)[kA + s.indices[i].near] += g;
      (*gradient)[kA + kB + s.indices[i].far] += g;
    }
    return all;
  }

 private:
  const Encoding& encoding_;
  const Recipe& recipe_;
};

// The area left to the near pixel by a line between both ends, at the centre of the distance
// classes.
double analytic_weight(int near_code, int far_code, int near_distance, int far_distance) {
  constexpr int kNone = 0, kOwn = 1, kOther = 2, kBoth = 3;
  if (near_code == kBoth && (far_code == kOwn || far_code == kOther)) near_code = 3 - far_code;
  if (far_code == kBoth && (near_code == kOwn || near_code == kOther)) far_code = 3 - near_code;
  if (near_code == kBoth || far_code == kBoth) near_code = far_code = kNone;
  const double length = near_distance + far_distance + 1;
  const auto half = [&](int code, int distance) {
    return code == kOwn ? std::max(0.0, 0.5 * (1 - (2 * distance + 1) / length)) : 0;
  };
  double weight = half(near_code, near_distance) + half(far_code, far_distance);
  if (near_distance == far_distance)
    weight += 0.125 / length * ((near_code == kOwn ? 1 : 0) + (far_code == kOwn ? 1 : 0));
  return std::clamp(weight, 0.03, 0.49);
}

Weights weights_of(const WeightTables& tables) {
  Weights weights;
  const auto take = [&](const auto& table) {
    for (const std::int8_t v : table) weights.push_back(v / kUnit);
  };
  take(tables.of_codes);
  take(tables.of_near);
  take(tables.of_far);
  return weights;
}

}  // namespace

std::string Recipe::text() const {
  return fmt::format("adam batches={} batch={} rate={} axis={} decay={} seed={}", batches, batch,
                     rate, axis_slope, decay, seed);
}

WeightTables first_guess() {
  constexpr std::array<int, 8> kDistances = {0, 1, 2, 3, 4, 7, 12, 24};
  WeightTables tables;
  tables.of_near.fill(0);
  tables.of_far.fill(0);
  for (int i = 0; i < static_cast<int>(kA); ++i) {
    const double weight =
        analytic_weight(i >> 8, i >> 6 & 3, kDistances[static_cast<std::size_t>(i >> 3 & 7)],
                        kDistances[static_cast<std::size_t>(i & 7)]);
    tables.of_codes[static_cast<std::size_t>(i)] =
        static_cast<std::int8_t>(std::lround(kUnit * tb::logarithm(weight / (1 - weight))));
  }
  return tables;
}

WeightTables train(const std::vector<std::vector<WeightSample>>& frames, const Recipe& recipe,
                   const WeightTables& start, const std::function<void(int)>& batch_done) {
  DEBURR_CHECK(!frames.empty(), "no frames to train on");
  const Encoding encoding;
  const Pixel pixel(encoding, recipe);
  const Weights begun = weights_of(start);
  Weights weights = begun;

  std::vector<double> frame_weight;
  for (const auto& samples : frames) {
    DEBURR_CHECK(!samples.empty(), "a frame without an edge cannot be trained on");
    double sum = 0;
    for (const WeightSample& s : samples) sum += pixel(s, weights, 0, nullptr);
    frame_weight.push_back(static_cast<double>(samples.size()) / sum / recipe.batch);
  }

  constexpr double kFirst = 0.9, kSecond = 0.999, kTiny = 1e-8;
  tb::Random random(recipe.seed);
  Weights gradient(kAll), mean(kAll, 0), square(kAll, 0);
  double first_left = 1, second_left = 1;
  for (int step = 0; step < recipe.batches; ++step) {
    std::fill(gradient.begin(), gradient.end(), 0.0);
    for (int i = 0; i < recipe.batch; ++i) {
      const std::size_t f = random.below(static_cast<std::uint32_t>(frames.size()));
      const std::size_t s = random.below(static_cast<std::uint32_t>(frames[f].size()));
      pixel(frames[f][s], weights, frame_weight[f], &gradient);
    }
    first_left *= kFirst;
    second_left *= kSecond;
    const double rate = recipe.rate * 0.5 * (1 + tb::sin_cos(tb::kPi * step / recipe.batches).cos);
    for (std::size_t i = 0; i < kAll; ++i) {
      mean[i] += (1 - kFirst) * (gradient[i] - mean[i]);
      square[i] += (1 - kSecond) * (gradient[i] * gradient[i] - square[i]);
      weights[i] -=
          rate * (mean[i] / (1 - first_left)) / (std::sqrt(square[i] / (1 - second_left)) + kTiny);
      if (i >= kA) weights[i] -= rate * recipe.decay * (weights[i] - begun[i]);
    }
    if (batch_done) batch_done(step + 1);
  }
  WeightTables tables;
  std::size_t at = 0;
  const auto store = [&](auto& table) {
    for (std::int8_t& v : table)
      v = static_cast<std::int8_t>(std::clamp(std::lround(kUnit * weights[at++]), -128L, 127L));
  };
  store(tables.of_codes);
  store(tables.of_near);
  store(tables.of_far);
  return tables;
}

std::uint64_t hash_of(const std::string& text) {
  tb::FnvHash hash;
  for (const char c : text) hash.byte(static_cast<unsigned char>(c));
  return hash.value();
}

}  // namespace deburr::studies::training
