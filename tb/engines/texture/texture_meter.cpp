// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_meter.h"

#include <fmt/format.h>

#include "tb/env/collect.h"

namespace deburr::tb {

void TextureMeter::collect(Result& result) const {
  add_parts(result, unit_, 0);
  add(result, memory_);
  const std::uint64_t lines = unit_.cache.miss_queue.line_fills.value();
  const auto& fetcher = unit_.cache.block_fetcher;
  result.lines_filled += fetcher ? fetcher->memory_lines.value() : lines;

  const std::uint64_t bilinears = unit_.address.addresser.bilinears.value();
  const std::uint64_t fragments = unit_.filter.fragments.value();
  double texel_bytes = 4;  // also of blocks that are decoded before the cache
  if (!textures_.descriptors().empty()) {
    const spec::texture::Format format = textures_.descriptors()[0].format;
    const auto index = static_cast<std::size_t>(format);
    if (!spec::texture::is_compressed(format))
      texel_bytes = spec::texture::kFormatBytes[index];
    else if (unit_.parameters().decode == spec::texture::Decode::kAfter)
      texel_bytes = spec::texture::kFormatBlockBytes[index] / 16.0;
  }
  add(result, "fragments", fragments, "fragment", "Colours delivered.");
  add(result, "bilinears", bilinears, "request", "Bilinear requests, one per sample and level.");
  add(result, "bilinears_per_fragment", ratio(bilinears, fragments), "request/fragment",
      "Cycles per fragment without stalls, times texture.width.");
  add(result, "misses_per_texel", ratio(number(lines), 4 * number(bilinears)), "line/texel",
      "Line fills per requested texel.");
  const double texel_hits = 100 - 100 * ratio(number(lines), 4 * number(bilinears));
  add(result, "texel_hits_percent", texel_hits, "%",
      "Requested texels that caused no line fill: 100 - 100 x misses_per_texel.");
  if (looks_up()) collect_lookups(result, texel_hits);
  add(result, "texels_fetched_per_fragment",
      ratio(number(lines) * unit_.parameters().cache_line_bytes / texel_bytes, number(fragments)),
      "texel/fragment", "Texels of all fetched lines per fragment.");
  add(result, "fifo_depth", static_cast<std::uint64_t>(unit_.parameters().cache_fifo_depth),
      "request", "Entries of the latency FIFO, as configured or derived from the memory latency.");
  add_counters(result, unit_);
}

void TextureMeter::collect_lookups(Result& result, double texel_hits) const {
  const rtl::texture::TagUnit& tags = unit_.cache.tag_stage;
  const std::uint64_t lookups = tags.hits.value() + tags.merged.value() + tags.misses.value();
  const auto of_lookups = [&](const rtl::Counter& count) {
    return 100 * ratio(count.value(), lookups);
  };
  add(result, "lookup_hits_percent", of_lookups(tags.hits), "%",
      "Tag lookups, one per line of a request, that found their line in the data banks.");
  add(result, "lookup_merged_percent", of_lookups(tags.merged), "%",
      "Lookups that found a fill of their line in flight; they wait for it without a request.");
  add(result, "lookup_misses_percent", of_lookups(tags.misses), "%",
      "Lookups that requested a fill.");
  result.terminal.push_back(
      {"hits",
       fmt::format("{:.2f} % of lookups, {:.2f} % more merged with a fill in flight; {:.2f} "
                   "% of texels",
                   of_lookups(tags.hits), of_lookups(tags.merged), texel_hits)});
}

void TextureMeter::show_parts(Observer& observer, const rtl::LinkBase& in,
                              const rtl::LinkBase& out) const {
  show(observer, "quads_in", in);
  show(observer, unit_);
  show(observer, "colours_out", out);
  observer.see({"Bilinear requests", figure("texel_addresser_bilinears"), "bilinear/clk",
                static_cast<double>(unit_.parameters().width)});
}

void TextureMeter::collect_headline(Result& result) const {
  result.latency = latency_of(unit_.fragment_latency);
  result.throughput = ratio(unit_.address.addresser.bilinears.value(), result.cycles);
  result.throughput_unit = "bilinear/clk";
  result.throughput_bound = unit_.parameters().width;
  result.throughput_bound_meaning = unit_.parameters().width == 1
                                        ? "One bilinear request per cycle."
                                        : "Bilinear requests per cycle: texture.width.";
  result.figures = {{"Fragments", key("fragments")},
                    {"Bilinear requests per fragment", key("bilinears_per_fragment")},
                    {"Line fills per texel", key("misses_per_texel")},
                    {"Texels without a line fill", key("texel_hits_percent")}};
  if (looks_up()) {
    result.figures.push_back({"Lookups that hit", key("lookup_hits_percent")});
    result.figures.push_back({"Lookups merged with a fill", key("lookup_merged_percent")});
  }
  result.figures.push_back({"Texels fetched per fragment", key("texels_fetched_per_fragment")});
  const rtl::Unit& filter = unit_.filter;
  if (!unit_.address.derivative.replaced() && looks_up() && !filter.replaced())
    result.bottleneck = find_bottleneck(result.units, figure(filter.basename()));
}

}  // namespace deburr::tb
