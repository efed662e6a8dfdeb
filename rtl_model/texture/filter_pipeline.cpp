// SPDX-License-Identifier: MIT
#include "rtl_model/texture/filter_pipeline.h"

#include <bit>
#include <string>

#include "rtl_model/texture/datasheets.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"
#include "spec/texture/tables.h"

namespace deburr::rtl::texture {
namespace {

constexpr std::uint32_t kCodedChannels = 4 * 3;

spec::texture::Format format_of(const TexelQuadToken& token) {
  return static_cast<spec::texture::Format>(token.control.format);
}

// Widens channels to eight bits by repeating their high bits (wires). Result U8.4.
constexpr std::uint32_t unorm8(std::uint32_t v) { return (v & 255) << 4; }
constexpr std::uint32_t unorm6(std::uint32_t v) { return unorm8((v & 63) << 2 | (v & 63) >> 4); }
constexpr std::uint32_t unorm5(std::uint32_t v) { return unorm8((v & 31) << 3 | (v & 31) >> 2); }
constexpr std::uint32_t unorm4(std::uint32_t v) { return unorm8((v & 15) << 4 | (v & 15)); }
constexpr std::uint32_t kOpaque = unorm8(255);

constexpr std::size_t kMostSamples = 16;
std::size_t weight_address(std::size_t last_index, std::size_t index) {
  return kMostSamples * last_index + index;
}
// `kernel = axis`: the tents follow the boxes.
std::vector<std::uint16_t> weight_words(const spec::texture::Configuration& p) {
  using spec::texture::Kernel;
  std::vector<std::uint16_t> words;
  const auto add = [&](Kernel kernel) {
    const auto& by_count = spec::texture::kKernelWeights[static_cast<std::size_t>(kernel)];
    for (std::size_t n = 1; n <= kMostSamples; ++n)
      words.insert(words.end(), by_count[n].begin(), by_count[n].end());
  };
  add(p.kernel == Kernel::kTent ? Kernel::kTent : Kernel::kBox);
  if (selects_kernel(p)) add(Kernel::kTent);
  return words;
}
bool has_weights(const spec::texture::Configuration& p) {
  return p.count == spec::texture::CountRule::kAny || p.kernel == spec::texture::Kernel::kTent ||
         selects_kernel(p);
}

// Bits dropped from the U8.20 sum: for an output channel, and for U8.4 light to be encoded.
constexpr unsigned kToByte = 20, kToLight = 16;

}  // namespace

template <class Width>
FilterPipelineOf<Width>::FilterPipelineOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                                          const spec::texture::Configuration& configuration,
                                          LatencyProbe& probe, std::int32_t width)
    : FilterPipelineBase(name, clock),
      by_level_(configuration.blend == spec::texture::Blend::kLevel),
      probe_(probe),
      srgb_("srgb",
            {.words = spec::texture::kSrgbToLinear.size(),
             .word_bits = 12,
             .kind = MemoryKind::kRom,
             .read_ports = kCodedChannels * static_cast<std::uint32_t>(width),
             .write_ports = 0,
             .latency = 1,
             .content = "sRGB channel to linear light"},
            spec::texture::kSrgbToLinear) {
  const auto lanes = static_cast<std::uint32_t>(width);
  for (std::uint32_t lane = 0; lane < lanes; ++lane)
    for (std::uint32_t i = 0; i < kCodedChannels; ++i)
      linear_.emplace_back(
          srgb_, numbered(("texel_" + std::to_string(i / 3) + "_" + "rgb"[i % 3]).c_str(), lane));
  if (has_weights(configuration)) {
    weight_words_ = weight_words(configuration);
    weights_ =
        std::make_unique<Memory<std::uint16_t>>("weights",
                                                MemoryShape{.words = weight_words_.size(),
                                                            .word_bits = 9,
                                                            .kind = MemoryKind::kRom,
                                                            .read_ports = lanes,
                                                            .write_ports = 0,
                                                            .latency = 1,
                                                            .content = "weight of sample i of N"},
                                                weight_words_);
    for (std::uint32_t lane = 0; lane < lanes; ++lane)
      weight_reads_.emplace_back(*weights_, numbered("sample", lane));
  }
  if (configuration.srgb_output == spec::texture::SrgbOutput::kEncoded) {
    codes_ = std::make_unique<Memory<std::uint8_t>>(
        "codes",
        MemoryShape{.words = spec::texture::kLinearToSrgb.size(),
                    .word_bits = 8,
                    .kind = MemoryKind::kRom,
                    .read_ports = 3 * lanes,
                    .write_ports = 0,
                    .latency = 1,
                    .content = "linear light to sRGB channel"},
        spec::texture::kLinearToSrgb);
    for (std::uint32_t lane = 0; lane < lanes; ++lane)
      for (const char* user : {"r", "g", "b"})
        code_reads_.emplace_back(*codes_, numbered(user, lane));
  }
}

// Last stage first, so that each stage reads its predecessor's registers from the previous cycle.
template <class Width>
Activity FilterPipelineOf<Width>::tick(Cycle cycle) {
  const bool arrives = texels_in.can_pop(cycle);
  if (requests_.empty() && samples_.empty() && totals_.empty() && rounded_.empty() && !arrives)
    return kIdle;
  count_stages(arrives);
  if (!(codes_ ? rounded_ : totals_).empty() && !colours_out.can_push(cycle))
    return kStalledDownstream;
  if (!rounded_.empty()) encode(cycle);
  if (!totals_.empty()) round(cycle);
  samples_.take([this](const Sample& sample, std::size_t) { accumulate(sample); });
  requests_.move();
  if (const auto* group = requests_.at(6))
    for (std::size_t i = 0; i < count_of(*group); ++i) lerp_levels(nth(*group, i));
  if (auto* group = requests_.at(2))
    for (std::size_t i = 0; i < count_of(*group); ++i) filter(cycle, nth(*group, i), i);
  if (arrives) {
    const auto& tokens = texels_in.take(cycle);
    auto& group = requests_.enter();
    set_count(group, count_of(tokens));
    for (std::size_t i = 0; i < count_of(tokens); ++i) {
      nth(group, i).token = nth(tokens, i);
      look_up(cycle, nth(tokens, i), i);
    }
  }
  return kBusy;
}

// Counts the stages that have a token in this cycle.
template <class Width>
inline void FilterPipelineOf<Width>::count_stages(bool arrives) {
  occupancy[6] += !samples_.empty();
  occupancy[7] += !totals_.empty();
  occupancy[8] += !rounded_.empty();
  if (arrives && requests_.full()) [[likely]] {
    for (std::size_t i = 0; i < kRequestStages; ++i) ++occupancy[i];
    return;
  }
  occupancy[0] += arrives;
  for (std::size_t stage = 2; stage <= kRequestStages; ++stage)
    occupancy[stage - 1] += requests_.at(stage - 1) != nullptr;
}

// Stage 1: ROM addresses for sRGB channels and for the weight of the sample.
template <class Width>
inline void FilterPipelineOf<Width>::look_up(Cycle cycle, const TexelQuadToken& token,
                                             std::size_t lane) {
  // All lanes read in the same cycle, so one of them is enough for the check.
  if (lane == 0 && weights_ && (by_level_ | token.control.last_of_sample))
    weight_reads_[lane].read(cycle, weight_address(token.control.last_index, token.control.index));
  if (!token.ticket.valid || format_of(token) != spec::texture::Format::kSrgb8A8) return;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      linear_[kCodedChannels * lane + 3 * i + c].read(cycle, token.texel[i] >> (8 * c) & 255);
}

// Stages 3 to 5; nothing in between is observable.
template <class Width>
template <class Unpack>
inline void FilterPipelineOf<Width>::lerp(Request& request, Unpack&& unpack) {
  const FilterControl& control = request.token.control;
  // Stages 3 and 4: U8.4 x U1.8.
  const std::uint32_t right = control.fraction_u, left = 256 - right;
  const Channels upper = unpack(0) * left + unpack(1) * right,
                 lower = unpack(2) * left + unpack(3) * right;
  // Stage 5: U8.20, rounded to U8.12.
  const std::uint32_t down = control.fraction_v, up = 256 - down;
  request.row = (upper * up + lower * down).rounded(8);
}

// The same for RGBA8: both columns of a row in one word, with 16 bits per channel. The sums are
// exact, so the model may lerp vertically first. Then one multiplication of two columns by their
// weights adds both products in its high half.
template <class Width>
inline void FilterPipelineOf<Width>::lerp_bytes(Request& request) {
  constexpr std::uint64_t kBytes = 0x00FF'00FF'00FF'00FF, kColumns = 0x0000'FFFF'0000'FFFF;
  const FilterControl& control = request.token.control;
  const auto& texel = request.token.texel;
  const std::uint64_t right = control.fraction_u, left = 256 - right;
  const std::uint32_t down = control.fraction_v, up = 256 - down;
  const std::uint64_t upper = texel[0] | std::uint64_t{texel[1]} << 32,
                      lower = texel[2] | std::uint64_t{texel[3]} << 32;
  const std::uint64_t rb = (upper & kBytes) * up + (lower & kBytes) * down,
                      ga = (upper >> 8 & kBytes) * up + (lower >> 8 & kBytes) * down;
  const std::uint64_t weights = left << 32 | right;
  const auto row = [weights](std::uint64_t pair) {
    const std::uint64_t first = (pair & kColumns) * weights,
                        second = (pair >> 16 & kColumns) * weights;
    return first >> 32 | second >> 32 << 32;
  };
  request.row = Channels{row(rb), row(ga)}.rounded(4);
}

// Stage 2. A fragment with an invalid descriptor has one sample of weight 0.
template <class Width>
inline std::uint32_t FilterPipelineOf<Width>::weight(Cycle cycle, const TexelQuadToken& token,
                                                     std::size_t lane) const {
  if (!token.ticket.valid) return 0;
  if (!weights_) return 256U >> std::bit_width(unsigned{token.control.last_index});
  const std::size_t address = weight_address(token.control.last_index, token.control.index);
  return lane == 0 ? weight_reads_[0].at(cycle, address) : weight_words_[address];
}

// Stages 2 to 5.
template <class Width>
inline void FilterPipelineOf<Width>::filter(Cycle cycle, Request& request, std::size_t lane) const {
  const TexelQuadToken& token = request.token;
  if (by_level_ | token.control.last_of_sample) request.weight = weight(cycle, token, lane);
  if (format_of(token) != spec::texture::Format::kRgba8) return filter_other(cycle, request, lane);
  lerp_bytes(request);
}

template <class Width>
void FilterPipelineOf<Width>::filter_other(Cycle cycle, Request& request, std::size_t lane) const {
  const TexelQuadToken& token = request.token;
  const auto lerp_each = [&](auto&& unpack_one) {
    lerp(request, [&](std::size_t i) { return unpack_one(token.texel[i]); });
  };
  switch (format_of(token)) {
    case spec::texture::Format::kRgba8:
      return;
    case spec::texture::Format::kRgb565:
      return lerp_each([](std::uint32_t raw) {
        return Channels::of(unorm5(raw >> 11), unorm6(raw >> 5), unorm5(raw), kOpaque);
      });
    case spec::texture::Format::kRgba4444:
      return lerp_each([](std::uint32_t raw) {
        return Channels::of(unorm4(raw >> 12), unorm4(raw >> 8), unorm4(raw >> 4), unorm4(raw));
      });
    case spec::texture::Format::kL8:
      return lerp_each([](std::uint32_t raw) {
        return Channels::of(unorm8(raw), unorm8(raw), unorm8(raw), kOpaque);
      });
    case spec::texture::Format::kSrgb8A8:
      if (!token.ticket.valid) return;  // its weight is 0
      return lerp(request, [&](std::size_t i) { return unpack_srgb(cycle, token, i, lane); });
    default:
      return;
  }
}

template <class Width>
typename FilterPipelineOf<Width>::Channels FilterPipelineOf<Width>::unpack_srgb(
    Cycle cycle, const TexelQuadToken& token, std::size_t texel, std::size_t lane) const {
  const std::uint32_t raw = token.texel[texel];
  const auto linear = [&](std::size_t channel) {
    return linear_[kCodedChannels * lane + 3 * texel + channel].at(cycle,
                                                                   raw >> (8 * channel) & 255);
  };
  return Channels::of(linear(0), linear(1), linear(2), unorm8(raw >> 24));
}

// Stage 6: sums the levels of a sample in U8.20, rounds once to U8.12, forwards after the last
// level. With `blend = level` it sums the samples of a level in U8.20 and forwards after the last.
template <class Width>
inline void FilterPipelineOf<Width>::lerp_levels(const Request& request) {
  if (by_level_) [[unlikely]]
    return sum_level(request);
  const FilterControl& control = request.token.control;
  level_sum_ = level_sum_ + request.row * control.level_weight;
  if (!control.last_of_sample) return;
  Sample& sample = samples_.add();
  sample.ticket = request.token.ticket;
  sample.weight = request.weight;
  sample.format = control.format;
  sample.last_of_fragment = control.last_of_fragment;
  sample.value = level_sum_.rounded(8);
  level_sum_ = {};
}

template <class Width>
void FilterPipelineOf<Width>::sum_level(const Request& request) {
  const FilterControl& control = request.token.control;
  level_sum_ = level_sum_ + request.row * request.weight;
  if (!control.last_of_sample) return;
  samples_.add() = {request.token.ticket, control.level_weight, control.format,
                    control.last_of_fragment, level_sum_};
  level_sum_ = {};
}

// Stage 7: sums samples in U8.20, forwards after the last sample of the fragment.
template <class Width>
inline void FilterPipelineOf<Width>::accumulate(const Sample& sample) {
  if (by_level_) [[unlikely]]
    return blend_level(sample);
  kernel_sum_ = kernel_sum_ + sample.value * sample.weight;
  if (!sample.last_of_fragment) return;
  totals_.add() = {sample.ticket, sample.format, kernel_sum_};
  kernel_sum_ = {};
}

// `blend = level`: sums levels in U8.28 and forwards U8.20. The bits dropped lie below those that
// decide the rounding of stage 8.
template <class Width>
void FilterPipelineOf<Width>::blend_level(const Sample& sample) {
  const auto level = sample.value.each();
  for (std::size_t c = 0; c < 4; ++c) blend_sum_[c] += std::uint64_t{level[c]} * sample.weight;
  if (!sample.last_of_fragment) return;
  const auto kept = [&](std::size_t c) { return static_cast<std::uint32_t>(blend_sum_[c] >> 8); };
  totals_.add() = {sample.ticket, sample.format, Channels::of(kept(0), kept(1), kept(2), kept(3))};
  blend_sum_ = {};
}

template <class Width>
inline bool FilterPipelineOf<Width>::coded(const Total& total) const {
  return codes_ && total.ticket.valid &&
         total.format == static_cast<std::uint8_t>(spec::texture::Format::kSrgb8A8);
}

// Stage 8: the weights sum to 1. With `encoded`, light addresses the ROM.
template <class Width>
inline void FilterPipelineOf<Width>::round(Cycle cycle) {
  if (!codes_) {
    spec::texture::ColourGroup& group = begin_beat(cycle, totals_.count);
    totals_.take([&](const Total& total, std::size_t lane) {
      deliver(cycle, group.colour[lane], total.ticket, total.value.rounded(kToByte).each());
    });
    return;
  }
  totals_.take([&](const Total& total, std::size_t lane) {
    rounded_.add() = {total.ticket, total.format, total.value.rounded(kToByte)};
    if (!coded(total)) return;
    const auto light = total.value.rounded(kToLight).each();
    for (std::size_t c = 0; c < 3; ++c) code_reads_[3 * lane + c].read(cycle, light[c]);
  });
}

// Stage 9.
template <class Width>
void FilterPipelineOf<Width>::encode(Cycle cycle) {
  spec::texture::ColourGroup& group = begin_beat(cycle, rounded_.count);
  rounded_.take([&](const Total& rounded, std::size_t lane) {
    auto rgba = rounded.value.each();
    if (coded(rounded))
      for (std::size_t c = 0; c < 3; ++c) rgba[c] = code_reads_[3 * lane + c].word(cycle);
    deliver(cycle, group.colour[lane], rounded.ticket, rgba);
  });
}

template <class Width>
inline spec::texture::ColourGroup& FilterPipelineOf<Width>::begin_beat(Cycle cycle,
                                                                       std::uint8_t colours) {
  spec::texture::ColourGroup& group = colours_out.emplace(cycle);
  group.count = colours;
  return group;
}

template <class Width>
inline void FilterPipelineOf<Width>::deliver(Cycle cycle, spec::texture::Colour& colour,
                                             const Ticket& ticket,
                                             const std::array<std::uint32_t, 4>& rgba) {
  colour.tag = ticket.tag;
  colour.lane = ticket.lane;
  colour.last = ticket.last;
  for (std::size_t c = 0; c < 4; ++c) colour.rgba[c] = static_cast<std::uint8_t>(rgba[c]);
  ++fragments;
  fragment_latency.record(probe_.leaves(cycle + 1));
}

template <class Width>
void FilterPipelineOf<Width>::reset() {
  requests_.reset();
  level_sum_ = {};
  samples_.count = 0;
  kernel_sum_ = {};
  blend_sum_ = {};
  totals_.count = rounded_.count = 0;
}

template <class Width>
Datasheet FilterPipelineOf<Width>::datasheet(const spec::texture::Parameters& p) {
  using spec::texture::Blend, spec::texture::SrgbOutput;
  const std::uint32_t w = Sizes(p).width;
  const bool by_level = p.blend == Blend::kLevel, encoded = p.srgb_output == SrgbOutput::kEncoded;
  const bool rom = has_weights(p);
  // Tag, lane, last and valid; for the codes also the descriptor's valid bit and the format.
  const std::uint32_t ticket = 32 + 2 + 1 + 1 + (encoded ? 1 + 3 : 0);
  constexpr std::uint32_t kFraction = 8, kWeight = 9, kFlags = 2;
  // Of each channel in stage 7.
  const std::uint32_t value = by_level ? 28 : 20, sum = value + 8;
  // Adders in series to the sums of a group of requests in order, before that of the cycle before.
  const auto scan = static_cast<std::uint32_t>(std::bit_width(w - 1));
  Datasheet sheet = {
      .unit = "FilterPipeline",
      .variant = chosen("srgb_output", spec::texture::kSrgbOutputNames, p.srgb_output) +
                 (rom ? ", ROM `weights`" : ", no ROM `weights`") +
                 (by_level ? ", `blend = level`" : "") + (w > 1 ? ", " + chosen("width", w) : ""),
      .does = "Filters four texels per cycle to the colour of a fragment.",
      .latency = {encoded ? 9U : 8U},
      .stages = {{.clock = "1",
                  .work = "fields",
                  .registers = (encoded ? ticket : ticket + 1 + 3) + 2 * kFraction + kWeight +
                               kFlags + (rom ? 0 : 4) + 4 * 32},
                 {.clock = "2",
                  .work = "unpack (sRGB: ROM), weight (ROM)",
                  .operators = {16 * op::mux(8, 4), 12 * op::mux(12, 2), op::logic(20)},
                  .longest = {op::rom_read(12, 256), op::mux(12, 2)},
                  .registers = ticket + 2 * kFraction + 2 * kWeight + kFlags + 16 * 12},
                 {.clock = "3",
                  .work = "horizontal products",
                  .operators = {16 * op::multiply(12, 9), op::subtract(9)},
                  .longest = {op::subtract(9), op::multiply(12, 9)},
                  .registers = ticket + kFraction + 2 * kWeight + kFlags + 16 * 20},
                 {.clock = "4",
                  .work = "horizontal sums",
                  .operators = {8 * op::add(20)},
                  .longest = {op::add(20)},
                  .registers = ticket + kFraction + 2 * kWeight + kFlags + 8 * 20},
                 {.clock = "5",
                  .work = "vertical lerp",
                  .operators = {8 * op::multiply(20, 9), 4 * op::add(28), op::subtract(9)},
                  .longest = {op::subtract(9), op::multiply(20, 9), op::add(28)},
                  .registers = ticket + 2 * kWeight + kFlags + 4 * 20},
                 {.clock = "6",
                  .work = "level lerp (`blend = level`: sum over the samples of a level)",
                  .operators = {4 * op::multiply(20, 9), 4 * op::add(28)},
                  .longest = {op::multiply(20, 9), (scan + 1) * op::add(28)},
                  .registers = ticket + kWeight + 1 + 4 * 28},
                 {.clock = "7",
                  .work =
                      "round the level lerp, multiply by the weight, accumulate (`blend = level`: "
                      "level lerp)",
                  .operators = {4 * op::multiply(value, 9), 4 * op::add(sum),
                                op::logic(4 * (28 + sum))},
                  .longest = {op::multiply(value, 9), (scan + 1) * op::add(sum)},
                  .registers = ticket + 4 * sum},
                 {.clock = "8",
                  .work = "round, pack",
                  .operators = {4 * op::add(8)},
                  .longest = {op::add(encoded ? 12 : 8)},
                  .registers = encoded ? ticket + 4 * 8 : 0}},
      .formats =
          "U8.4 after stage 2, U8.12 after 4 and 5, U8.20 in 6 and 7, U8.0 out (`encoded`: U8.4 "
          "after 8); rounded in 5, 7 and 8; `blend = level`: U8.28 in 7, rounded in 5 and 8.",
      .copies = w,
      .per = "request"};
  auto& stages = sheet.stages;
  if (!by_level) {
    stages[6].operators.insert(stages[6].operators.begin(), 4 * op::add(20));
    stages[6].longest.insert(stages[6].longest.begin(), op::add(20));
  }
  if (encoded) {
    stages[7].operators.push_back(3 * op::add(12));
    stages.push_back({.clock = "9",
                      .work = "codes (ROM)",
                      .operators = {3 * op::mux(8, 2)},
                      .longest = {op::rom_read(8, 4096), op::mux(8, 2)}});
  }
  for (Stage& stage : stages) stage.on = "stage_" + stage.clock;
  // The sums of a group; the colours of a beat, in order.
  if (w > 1) sheet.shared = {2 * w * scan * op::add(28), 2 * w * scan * op::add(sum)};
  for (std::uint32_t lane = 1; lane < w; ++lane)
    sheet.shared.push_back(op::mux(kPayloadBits<spec::texture::Colour>, lane + 1));
  return sheet;
}

template class FilterPipelineOf<Narrow>;
template class FilterPipelineOf<Wide>;

}  // namespace deburr::rtl::texture
