// SPDX-License-Identifier: MIT
#include "rtl_model/texture/datasheets.h"

#include <algorithm>
#include <bit>
#include <string>

#include "rtl_model/texture/texture_unit.h"

namespace deburr::rtl::texture {
namespace {

// Composite parts: their latency is the sum over their parts.
std::vector<Datasheet> sums(const spec::texture::Parameters& p) {
  std::vector<Datasheet> sheets = {TextureUnit::datasheet(p), AddressUnit::datasheet(p)};
  for (Datasheet& sheet : sheets)
    sheet.variant = "`preset = " +
                    std::string(spec::texture::kPresetNames[static_cast<std::size_t>(p.preset)]) +
                    "`";
  sheets.push_back(TextureCache::datasheet(p));
  return sheets;
}

// The sheets of the page; that of the memory port is in its section of the fabric.
std::vector<Datasheet> units(const spec::texture::Parameters& p) {
  const bool wide = p.width > 1;
  std::vector<Datasheet> sheets = {
      DerivativeUnit::datasheet(p),
      p.axes == spec::texture::Axes::kTwo ? FootprintUnit::datasheet(p) : AxisUnit::datasheet(p),
      Log2Unit::datasheet(p),
      LevelUnit::datasheet(p),
      SampleWalker::datasheet(p),
      TexelAddresser::datasheet(p)};
  if (wide) sheets.push_back(GroupFormer::datasheet(p));
  sheets.insert(sheets.end(), {wide ? WideTagStage::datasheet(p) : TagStage::datasheet(p),
                               MissQueue::datasheet(p), FillBuffer::datasheet(p),
                               wide ? WideLatencyFifo::datasheet() : LatencyFifo::datasheet(),
                               wide ? WideDataStage::datasheet(p) : DataStage::datasheet(p),
                               FilterPipeline::datasheet(p), Descriptors::datasheet(p)});
  if (has_fetcher(p)) sheets.push_back(BlockFetcher::datasheet(p));
  if (has_decoders(p))
    sheets.push_back(wide ? wide::BlockDecoder::datasheet(p) : BlockDecoder::datasheet(p));
  return sheets;
}

}  // namespace

Sizes::Sizes(const spec::texture::Parameters& p) {
  const auto u = [](std::int32_t number) { return static_cast<std::uint32_t>(number); };
  const bool two = p.axes == spec::texture::Axes::kTwo;
  fragments = u(p.fragments);
  width = u(p.width);
  axis_cycles = u(p.axis_cycles);
  candidates = (two ? 2U : p.axes == spec::texture::Axes::kFour ? 4U : 8U) / axis_cycles;
  axis = two ? 33 : 34;
  minor = two ? 32 : 47;
  const std::uint32_t tent = selects_kernel(p) ? u(tent_spread(p.spread)) : 0,
                      spread = std::max(u(p.spread), tent) >>
                               std::countr_zero(u(p.spread) | tent | 0x100);
  step = axis + (spread > 1 ? static_cast<std::uint32_t>(std::bit_width(spread)) : 0);
  position = position_bits(p);
  walking = width > 1 ? 2 : 1;
  texels = 4 * width;
  offset = log2_of(p.cache_line_bytes);
  line = line_bits(p);
  slot = log2_of(p.cache_bytes) - offset;
  set = slot - log2_of(p.cache_ways);
  tag = line - set;
  sets = 1U << set;
  ways = u(p.cache_ways);
  const bool ordered = p.cache_replacement != spec::texture::Replacement::kRandom;
  set_word = ways * (tag + 2) + (ordered ? ways * (ways - 1) / 2 : 0);
  lookups = u(p.cache_lookups);
  allocations = u(p.cache_allocations);
  outstanding = u(MissQueue::entries(p, {}));
  words = u(p.cache_line_bytes) / 4;
  line_banks = u(p.cache_line_banks);
  bank_reads = u(p.cache_bank_reads);
  fill_writes = u(p.cache_fill_writes);
}

std::string chosen(const char* parameter, std::string_view value) {
  return std::string("`").append(parameter).append(" = ").append(value).append("`");
}
std::string chosen(const char* parameter, std::uint64_t value) {
  return chosen(parameter, std::to_string(value));
}
std::string with_decode(const spec::texture::Build& p) {
  return p.decode != spec::texture::Decode::kNone
             ? ", " + chosen("decode", spec::texture::kDecodeNames, p.decode)
             : "";
}
std::string with_decoders(const spec::texture::Build& p) {
  return has_decoders(p) ? with_decode(p) : "";
}
std::string with_blocks(const spec::texture::Build& p) {
  return p.decode != spec::texture::Decode::kNone ? ", `decode = after` or `before`" : "";
}
std::string chosen_axes(const spec::texture::Parameters& p) {
  return p.axes == spec::texture::Axes::kTwo ? "`axes = two`" : "`axes = four` or `eight`";
}

std::string sets_text(const spec::texture::Parameters& p) {
  const Sizes z(p);
  return std::to_string(z.sets) + " sets of " + std::to_string(z.ways) + " ways, " +
         chosen("cache.replacement", spec::texture::kReplacementNames, p.cache_replacement);
}

SideHardware side_hardware(spec::texture::FootprintRule rule, std::uint32_t sides) {
  using spec::texture::FootprintRule;
  const Operator longer = op::maximum(31), shorter = op::mux(31, 2), sum = op::add(32);
  switch (rule) {
    case FootprintRule::kHalf:
    case FootprintRule::kQuarter:
      return {{sides * longer, sides * shorter, sides * sum}, {longer, sum}, sides * 32};
    case FootprintRule::kTwoSegment:
      return {{sides * longer, sides * shorter, 2 * sides * sum, sides * op::subtract(32)},
              {longer, op::subtract(32), sum},
              sides * 2 * 32};
    case FootprintRule::kMax:
    case FootprintRule::kExact:  // has squares instead
      break;
  }
  return {{sides * longer}, {longer}, sides * 31};
}

std::uint32_t signed_digits(std::uint32_t constant) {
  std::uint32_t digits = 0;
  for (; constant != 0; constant >>= 1) {
    if ((constant & 1) == 0) continue;
    ++digits;
    if ((constant & 3) == 3) constant += 2;  // -1: carries to the next digits
  }
  return digits;
}

std::vector<Datasheet> datasheets(const spec::texture::Parameters& p) {
  std::vector<Datasheet> sheets = units(p);
  sheets.push_back(TextureCache::memory_port_datasheet(p));
  return sheets;
}

std::vector<Datasheet> datasheets() {
  using namespace spec::texture;
  std::vector<std::vector<Datasheet>> builds;
  for (const PresetRow& row : kPresets) {
    Parameters p = preset_parameters(row.preset);
    builds.push_back(sums(p));
    builds.push_back(units(p));
    // Variants that the preset does not use.
    if (row.preset == Preset::kPaper) {
      p.footprint = FootprintRule::kExact;
      p.log2 = Log2Rule::kExact;
    } else {
      p.axes = Axes::kEight;
      p.footprint = FootprintRule::kHalf;
      p.srgb_output = SrgbOutput::kEncoded;
    }
    builds.push_back(units(p));
  }
  Parameters by_axis = preset_parameters(Preset::kDeburr);
  by_axis.kernel = Kernel::kAxis;
  builds.push_back({SampleWalker::datasheet(by_axis)});
  Parameters narrow = preset_parameters(Preset::kDeburr),
             wide = preset_parameters(Preset::kDeburr, NamedBuild::kWide);
  for (const Decode decode : {Decode::kNone, Decode::kAfter, Decode::kBefore})
    for (Parameters* const p : {&narrow, &wide}) {
      p->decode = decode;
      builds.push_back({TextureCache::datasheet(*p)});
      builds.push_back(units(*p));
    }
  return merged(builds);
}

}  // namespace deburr::rtl::texture
