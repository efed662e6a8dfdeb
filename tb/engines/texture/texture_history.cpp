// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>

#include "tb/engines/texture/texture_links.h"

namespace deburr::tb {
namespace {

using golden::texture::BilinearRequest;
using golden::texture::QuadColours;
using rtl::texture::LookUp;

// Exact decimal value of a binary fraction.
std::string fixed(std::int64_t value, int fraction_bits) {
  return fmt::format("{}", static_cast<double>(value) / static_cast<double>(1LL << fraction_bits));
}
std::string pair_of(std::int64_t s, std::int64_t t, int fraction_bits) {
  return fmt::format("{}, {}", fixed(s, fraction_bits), fixed(t, fraction_bits));
}
std::string sizes_of(const golden::texture::Step& step) {
  return pair_of(step.s < 0 ? -step.s : step.s, step.t < 0 ? -step.t : step.t, 16);
}
std::string colour_text(const std::array<std::uint8_t, 4>& rgba) {
  return fmt::format("{}, {}, {}, {}", rgba[0], rgba[1], rgba[2], rgba[3]);
}
std::string words_text(const std::array<std::uint32_t, 4>& w) {
  return fmt::format("{:#x}, {:#x}, {:#x}, {:#x}", w[0], w[1], w[2], w[3]);
}

// Distinct lines of a request, in order of first use (docs/reference/texture/compressed.md, "Before
// the cache").
constexpr std::uint32_t kCodecShift = 29;
std::vector<std::uint32_t> lines_of(const BilinearRequest& request, std::uint32_t line_bytes,
                                    std::uint32_t codec) {
  std::vector<std::uint32_t> lines;
  for (const std::uint32_t address : request.addresses)
    if (const std::uint32_t line = codec << kCodecShift | address / line_bytes;
        std::find(lines.begin(), lines.end(), line) == lines.end())
      lines.push_back(line);
  return lines;
}

}  // namespace

// ---- observation --------------------------------------------------------------------------------

TextureHistory::TextureHistory(rtl::ClockDomain& clock, rtl::texture::TextureUnit& unit,
                               const rtl::Link<spec::texture::Quad>& quads,
                               const rtl::Link<spec::texture::ColourGroup>& colours,
                               const PixelAddress& pixel)
    : pixel_(pixel),
      line_bytes_(static_cast<std::uint32_t>(unit.parameters().cache_line_bytes)),
      two_axes_(unit.parameters().axes == spec::texture::Axes::kTwo) {
  using namespace rtl::texture;
  monitors_.push_back(std::make_unique<Monitor<spec::texture::Quad>>(
      clock, quads, Monitor<spec::texture::Quad>::Callback(),
      [this](rtl::Cycle cycle, const spec::texture::Quad& quad) {
        for (Fragment& fragment : fragments_)
          if (fragment.quad.quad.tag == quad.tag) fragment.taken = cycle;
      }));
  see(clock, unit, "address_unit.derivatives", &Fragment::derivative);
  see(clock, unit, "address_unit.footprints", &Fragment::footprint);
  see(clock, unit, "address_unit.logs", &Fragment::log2);
  see(clock, unit, "address_unit.levels", &Fragment::level);
  see_all<SampleGroup>(clock, unit, "address_unit.samples", &Fragment::samples);
  see_all<TexelGroup>(clock, unit, "texels", &Fragment::texels);
  // A request leaves the TagStage in the cycle of its lookups, a group in that of its last ones.
  const bool groups = unit.cache.wide != nullptr;
  unit.cache.tag_stage.observer = [this, groups](rtl::Cycle cycle, std::uint32_t line,
                                                 LookUp outcome) {
    if (!groups && !looked_up_.empty() && looked_up_.front().cycle != cycle) looked_up_.clear();
    looked_up_.push_back({cycle, line, outcome});
  };
  if (groups)
    monitors_.push_back(std::make_unique<Monitor<CacheGroup>>(
        clock, link_of<CacheGroup>(unit, "texture_cache.requests"),
        [this](rtl::Cycle cycle, const CacheGroup& group) {
          auto next = looked_up_.begin();
          for (std::size_t i = 0; i < group.count; ++i) {
            const GroupRequest& request = group.at[i];
            const std::set<std::uint8_t> lines(request.index.begin(), request.index.end());
            const auto left = static_cast<std::size_t>(looked_up_.end() - next);
            const auto uses = static_cast<std::ptrdiff_t>(
                request.ticket.valid ? std::min(lines.size(), left) : 0);
            if (Fragment* fragment = find(request.ticket.tag, request.ticket.lane))
              fragment->lookups.emplace_back(std::vector<LookedUp>(next, next + uses), cycle);
            next += uses;
          }
          looked_up_.clear();
        }));
  else
    monitors_.push_back(std::make_unique<Monitor<CacheToken>>(
        clock, link_of<CacheToken>(unit, "texture_cache.requests"),
        [this](rtl::Cycle cycle, const CacheToken& token) {
          Fragment* const fragment = find(token.ticket.tag, token.ticket.lane);
          if (!fragment) return;
          fragment->lookups.emplace_back(std::vector<LookedUp>(), cycle);
          if (!looked_up_.empty() && looked_up_.front().cycle == cycle)
            fragment->lookups.back().first = looked_up_;
        }));
  see_all<TexelQuadGroup>(clock, unit, "texel_quads", &Fragment::data);
  // Colours are recorded when taken, to include changes while they wait.
  monitors_.push_back(std::make_unique<Monitor<spec::texture::ColourGroup>>(
      clock, colours, Monitor<spec::texture::ColourGroup>::Callback(),
      [this](rtl::Cycle cycle, const spec::texture::ColourGroup& group) {
        for (const spec::texture::Colour& colour : group)
          if (Fragment* fragment = find(colour.tag, colour.lane))
            fragment->delivered.emplace_back(colour, cycle);
      }));
}

template <class T>
void TextureHistory::see(rtl::ClockDomain& clock, const rtl::texture::TextureUnit& unit,
                         const char* link, Seen<T> Fragment::*where) {
  monitors_.push_back(watch_tokens<T, rtl::texture::FragmentGroup<T>>(
      clock, unit, link, [this, where](rtl::Cycle cycle, const T& token) {
        if (Fragment* fragment = find(token.ticket.tag, token.ticket.lane))
          (fragment->*where).emplace(token, cycle);
      }));
}

template <class Group, class T>
void TextureHistory::see_all(rtl::ClockDomain& clock, const rtl::texture::TextureUnit& unit,
                             const char* link, AllSeen<T> Fragment::*where) {
  monitors_.push_back(
      watch_tokens<T, Group>(clock, unit, link, [this, where](rtl::Cycle cycle, const T& token) {
        if (Fragment* fragment = find(token.ticket.tag, token.ticket.lane))
          (fragment->*where).emplace_back(token, cycle);
      }));
}

void TextureHistory::clear() {
  fragments_.clear();
  looked_up_.clear();
}

int TextureHistory::lane_of(const traces::TracedQuad& quad) const {
  if (!quad.placed) return -1;
  for (int lane = 0; lane < 4; ++lane)
    if ((quad.quad.coverage >> lane & 1) != 0 && quad.x(lane) == pixel_.x &&
        quad.y(lane) == pixel_.y)
      return lane;
  return -1;
}

TextureHistory::Fragment* TextureHistory::find(std::uint32_t tag, int lane) {
  for (Fragment& fragment : fragments_)
    if (fragment.quad.quad.tag == tag && fragment.lane == lane) return &fragment;
  return nullptr;
}

bool TextureHistory::send(const traces::TracedQuad& quad) {
  const int lane = lane_of(quad);
  if (lane < 0) return false;
  fragments_.push_back({.quad = quad, .lane = lane});
  return true;
}

QuadColours TextureHistory::expect(const traces::TracedQuad& quad,
                                   golden::texture::TextureGolden& golden) {
  Fragment& fragment = fragments_.back();
  fragment.golden = true;
  fragment.analysis = golden.analyse(quad.quad, fragment.lane);
  if (fragment.analysis.valid && golden.parameters().decode == spec::texture::Decode::kBefore) {
    const spec::texture::Format format = golden.texture(quad.quad.texture).format;
    fragment.block_bytes = spec::texture::kFormatBlockBytes[static_cast<std::size_t>(format)];
    if (fragment.block_bytes != 0)
      fragment.codec = 1 + static_cast<std::uint32_t>(format) -
                       static_cast<std::uint32_t>(spec::texture::Format::kBc1);
  }
  const QuadColours colours = golden.process(quad.quad, fragment.lane, fragment.requests);
  for (const spec::texture::Colour& colour : colours)
    if (colour.lane == fragment.lane) fragment.colour = colour.rgba;
  return colours;
}

// ---- report -------------------------------------------------------------------------------------

class TextureHistory::Writer {
 public:
  Writer(PixelHistory& history, const TextureHistory& from, const Fragment& fragment,
         std::string part, bool ended)
      : history_(history), from_(from), f_(fragment), part_(std::move(part)), ended_(ended) {}

  void write() {
    quad();
    derivative();
    footprint();
    level();
    const std::size_t requests =
        std::max({f_.requests.size(), f_.samples.size(), f_.texels.size(), f_.lookups.size()});
    for (std::size_t i = 0; i < requests; ++i) request(i);
    colour();
  }

 private:
  using Clock = std::optional<std::uint64_t>;
  template <class T>
  static Clock clock(const Seen<T>& seen) {
    return seen ? Clock(seen->second) : std::nullopt;
  }
  // Text of an observed value; empty if not observed.
  template <class T, class Text>
  static std::string text(const Seen<T>& seen, const Text& of) {
    return seen ? of(seen->first) : std::string();
  }
  template <class T>
  static Seen<T> at(const AllSeen<T>& all, std::size_t i) {
    return i < all.size() ? Seen<T>(all[i]) : std::nullopt;
  }
  // Text of a golden value; empty if the fragment could not be filtered.
  template <class Text>
  std::string golden(const Text& of) const {
    return f_.golden && f_.analysis.valid ? of(f_.analysis) : std::string();
  }
  // A fragment's steps precede its colour. A fragment without a descriptor has no steps.
  PixelSides came() const {
    if (!f_.golden || !f_.analysis.valid) return {};
    return {true, ended_ || !f_.delivered.empty()};
  }
  PixelStep row(std::string step, std::string item, std::string golden, std::string hardware,
                Clock at, bool detail = false) const {
    return {.part = part_,
            .step = std::move(step),
            .item = std::move(item),
            .golden = std::move(golden),
            .hardware = std::move(hardware),
            .clock = at,
            .detail = detail};
  }
  // Adds a step that only one side can have.
  void add_one_sided(std::string step, std::string item, std::string golden, std::string hardware,
                     Clock at = std::nullopt, bool detail = false) {
    history_.compare(
        row(std::move(step), std::move(item), std::move(golden), std::move(hardware), at, detail));
  }
  void add(std::string step, std::string item, std::string golden, std::string hardware, Clock at,
           bool detail = false) {
    history_.compare(
        row(std::move(step), std::move(item), std::move(golden), std::move(hardware), at, detail),
        came());
  }

  void quad() {
    const spec::texture::Quad& q = f_.quad.quad;
    const std::string sent = fmt::format("{}, {}, {}", q.tag, f_.lane, q.texture);
    add_one_sided("quad", "tag, lane, texture", sent, "", f_.taken);
    if (!f_.quad.shows(f_.lane))
      add_one_sided("quad", "seen", "no: another fragment of the pixel is", "");
    if (f_.golden && !f_.analysis.valid)
      add_one_sided("quad", "descriptor", "invalid: the colour is zero", "");
  }

  void derivative() {
    const auto& d = f_.derivative;
    const auto lane = static_cast<std::size_t>(f_.lane);
    add("coordinates", "s, t", pair_of(f_.quad.quad.s[lane], f_.quad.quad.t[lane], 24),
        text(d, [](const auto& t) { return pair_of(t.s, t.t, 24); }), clock(d));
    add("derivatives", "along the row, texels",
        golden([](const auto& a) { return sizes_of(a.p_x); }),
        text(d, [](const auto& t) { return pair_of(t.size_s_x, t.size_t_x, 16); }), clock(d), true);
    add("derivatives", "along the column, texels",
        golden([](const auto& a) { return sizes_of(a.p_y); }),
        text(d, [](const auto& t) { return pair_of(t.size_s_y, t.size_t_y, 16); }), clock(d), true);
  }

  void footprint() {
    const auto& f = f_.footprint;
    add("footprint", "major axis, texels",
        golden([](const auto& a) { return fixed(a.footprint.d_max, 16); }),
        text(f, [](const auto& t) { return fixed(t.d_max, 16); }), clock(f));
    const bool two = from_.two_axes_;
    const auto minor = [two](const auto& a) {
      return static_cast<std::int64_t>(two ? a.footprint.d_min : a.footprint.area);
    };
    add("footprint", two ? "minor axis, texels" : "area, texels",
        golden([&](const auto& a) { return fixed(minor(a), 16); }),
        text(f, [](const auto& t) { return fixed(static_cast<std::int64_t>(t.minor), 16); }),
        clock(f));
    add("footprint", "axis, coordinates",
        golden([](const auto& a) { return pair_of(a.axis.s, a.axis.t, 24); }),
        text(f, [](const auto& t) { return pair_of(t.axis_s, t.axis_t, 24); }), clock(f), true);
    add("footprint", "log2 of the major axis",
        golden([](const auto& a) { return fixed(a.lod.lb_d_max, 12); }),
        text(f_.log2, [](const auto& t) { return fixed(t.lb_max, 12); }), clock(f_.log2), true);
  }

  void level() {
    const auto& l = f_.level;
    const auto filter = [](bool linear) { return std::string(linear ? "linear" : "nearest"); };
    add("level", "samples N", golden([](const auto& a) { return std::to_string(a.lod.samples); }),
        text(l, [](const auto& t) { return std::to_string(t.last_index + 1); }), clock(l));
    add("level", "level and 256ths of the next",
        golden([](const auto& a) { return fmt::format("{}, {}", a.lod.level, a.lod.fraction); }),
        text(l, [](const auto& t) { return fmt::format("{}, {}", t.level, t.fraction); }),
        clock(l));
    add("level", "filter", golden([&](const auto& a) { return filter(a.lod.linear); }),
        text(l, [&](const auto& t) { return filter(t.linear); }), clock(l), true);
  }

  void request(std::size_t i) {
    const BilinearRequest* golden = i < f_.requests.size() ? &f_.requests[i] : nullptr;
    const auto sample = at(f_.samples, i);
    const auto texels = at(f_.texels, i);
    const auto data = at(f_.data, i);
    const std::string step =
        golden   ? fmt::format("sample {} level {}", golden->sample, golden->level)
        : sample ? fmt::format("sample {} level {}", sample->first.index, sample->first.level)
                 : fmt::format("request {}", i);
    add(step, "s, t", golden ? pair_of(golden->s, golden->t, 24) : "",
        text(sample, [](const auto& t) { return pair_of(t.s, t.t, 24); }), clock(sample));
    add(step, "texels at", golden ? words_text(golden->addresses) : "",
        text(texels, [](const auto& t) { return words_text(t.address); }), clock(texels), true);
    lines(i, step, golden);
    if (data)
      add_one_sided(step, "texels as stored", "",
                    text(data, [](const auto& t) { return words_text(t.texel); }), clock(data),
                    true);
  }

  // The golden model is untimed: it counts a line whose fill is outstanding as a hit.
  void lines(std::size_t i, const std::string& step, const BilinearRequest* golden) {
    constexpr std::array<const char*, 3> kOutcomes = {"hit", "merged", "miss"};
    const std::vector<LookedUp> seen =
        i < f_.lookups.size() ? f_.lookups[i].first : std::vector<LookedUp>();
    const std::uint32_t line_bytes = f_.block_bytes != 0 ? f_.block_bytes : from_.line_bytes_;
    const std::vector<std::uint32_t> expected =
        golden ? lines_of(*golden, line_bytes, f_.codec) : std::vector<std::uint32_t>();
    const auto misses = [&](std::size_t g) {
      return std::count(golden->misses.begin(), golden->misses.end(), expected[g]) > 0;
    };
    const auto line_text = [&](std::uint32_t line, const char* outcome) {
      const std::uint64_t number = line - (f_.codec << kCodecShift);
      return fmt::format("{:#x} {}", number * line_bytes, outcome);
    };
    history_.compare_records(
        expected.size(), seen.size(),
        [&](std::size_t g, std::size_t h) {
          return expected[g] == seen[h].line && misses(g) == (seen[h].outcome == LookUp::kMiss);
        },
        [&](PixelHistory::Record g, PixelHistory::Record h) {
          return row(
              step, "line", g ? line_text(expected[*g], misses(*g) ? "miss" : "hit") : "",
              h ? line_text(seen[*h].line, kOutcomes[static_cast<std::size_t>(seen[*h].outcome)])
                : "",
              h ? Clock(seen[*h].cycle) : std::nullopt);
        },
        came());
  }

  void colour() {
    history_.compare_records(
        f_.golden ? 1 : 0, f_.delivered.size(),
        [&](std::size_t, std::size_t h) { return f_.colour == f_.delivered[h].first.rgba; },
        [&](PixelHistory::Record g, PixelHistory::Record h) {
          const Seen<spec::texture::Colour> one = h ? at(f_.delivered, *h) : std::nullopt;
          return row("colour", "RGBA", g ? colour_text(f_.colour) : "",
                     text(one, [](const auto& c) { return colour_text(c.rgba); }), clock(one));
        },
        {f_.golden, ended_});
  }

  PixelHistory& history_;
  const TextureHistory& from_;
  const Fragment& f_;
  std::string part_;
  bool ended_;
};

PixelHistory TextureHistory::history(bool ended, bool all_sent) const {
  PixelHistory all{pixel_};
  if (!all_sent)
    all.note =
        fmt::format("the run was cut short before all quads were sent, {} of this pixel so far",
                    fragments_.size());
  else if (fragments_.empty())
    all.note = "no fragment of a texture covers it";
  for (std::size_t i = 0; i < fragments_.size(); ++i) {
    if (fragments_[i].delivered.empty())
      all.note += fmt::format("{}fragment {} was not delivered: the tag of its quad is {}",
                              all.note.empty() ? "" : "; ", i, fragments_[i].quad.quad.tag);
    Writer(all, *this, fragments_[i], fmt::format("fragment {}", i), ended).write();
  }
  return all;
}

}  // namespace deburr::tb
