// SPDX-License-Identifier: MIT
#include "tool/sweep/sampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "tb/base/random.h"

namespace deburr::tool {
namespace {

constexpr std::uint64_t kDrawsPerSample = 100;

// A position in the unit interval.
std::string value_at(const Axis& axis, double position) {
  if (!axis.span) {
    const auto size = static_cast<double>(axis.choices.size());
    const auto index = static_cast<std::size_t>(position * size);
    return axis.choices[std::min(index, axis.choices.size() - 1)].label;
  }
  const Span& span = *axis.span;
  if (span.integer)
    return fmt::format(
        "{:.0f}", std::min(span.to, span.from + std::floor(position * (span.to - span.from + 1))));
  return fmt::format("{:.9g}", span.from + position * (span.to - span.from));
}

void for_each_combination(const SweepDefinition& sweep,
                          const std::function<bool(const Sample&)>& take) {
  std::vector<std::size_t> index(sweep.axes.size(), 0);
  Sample sample;
  for (const Axis& axis : sweep.axes) sample.push_back(axis.choices.front().label);
  std::size_t axis = 0;
  do {
    take(sample);
    for (axis = sweep.axes.size(); axis > 0; --axis) {
      const std::vector<Choice>& choices = sweep.axes[axis - 1].choices;
      std::size_t& at = index[axis - 1];
      at = (at + 1) % choices.size();
      sample[axis - 1] = choices[at].label;
      if (at != 0) break;
    }
  } while (axis > 0);
}

void for_each_random(const SweepDefinition& sweep, const std::function<bool(const Sample&)>& take) {
  tb::Random random(sweep.sample_seed, "random sample");
  std::uint64_t taken = 0;
  Sample sample(sweep.axes.size());
  for (std::uint64_t draw = 0; taken < sweep.samples && draw < kDrawsPerSample * sweep.samples;
       ++draw) {
    for (std::size_t axis = 0; axis < sweep.axes.size(); ++axis)
      sample[axis] = value_at(sweep.axes[axis], random.uniform(0, 1));
    taken += take(sample) ? 1 : 0;
  }
}

void for_each_stratum(const SweepDefinition& sweep,
                      const std::function<bool(const Sample&)>& take) {
  tb::Random random(sweep.sample_seed, "latin sample");
  std::vector<std::vector<std::uint32_t>> strata(sweep.axes.size());
  for (std::vector<std::uint32_t>& order : strata) {
    order.resize(sweep.samples);
    std::iota(order.begin(), order.end(), 0u);
    for (std::size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[random.below(static_cast<std::uint32_t>(i))]);
  }
  Sample sample(sweep.axes.size());
  for (std::uint64_t i = 0; i < sweep.samples; ++i) {
    for (std::size_t axis = 0; axis < sweep.axes.size(); ++axis)
      sample[axis] = value_at(sweep.axes[axis], (strata[axis][i] + random.uniform(0, 1)) /
                                                    static_cast<double>(sweep.samples));
    take(sample);
  }
}

}  // namespace

std::uint64_t sample_bound(const SweepDefinition& sweep) {
  switch (sweep.sampling) {
    case SweepSampling::kListed:
      return sweep.axes.front().choices.size();
    case SweepSampling::kRandom:
    case SweepSampling::kLatin:
      return sweep.samples;
    case SweepSampling::kCartesian:
      break;
  }
  std::uint64_t product = 1;
  for (const Axis& axis : sweep.axes)
    if (__builtin_mul_overflow(product, axis.choices.size(), &product))
      return std::numeric_limits<std::uint64_t>::max();
  return product;
}

std::string sizes_of(const SweepDefinition& sweep) {
  std::vector<std::size_t> sizes;
  for (const Axis& axis : sweep.axes) sizes.push_back(axis.choices.size());
  return fmt::format("{}", fmt::join(sizes, " x "));
}

void for_each_sample(const SweepDefinition& sweep, const std::function<bool(const Sample&)>& take) {
  switch (sweep.sampling) {
    case SweepSampling::kCartesian:
      return for_each_combination(sweep, take);
    case SweepSampling::kRandom:
      return for_each_random(sweep, take);
    case SweepSampling::kLatin:
      return for_each_stratum(sweep, take);
    case SweepSampling::kListed: {
      Sample sample(sweep.axes.size());
      for (std::size_t i = 0; i < sweep.axes.front().choices.size(); ++i) {
        for (std::size_t axis = 0; axis < sweep.axes.size(); ++axis)
          sample[axis] = sweep.axes[axis].choices[i].label;
        take(sample);
      }
    }
  }
}

}  // namespace deburr::tool
