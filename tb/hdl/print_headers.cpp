// SPDX-License-Identifier: MIT
// Prints the headers included by the units of hdl/: bit positions of the fields of tokens and
// descriptors, codes of the options, and tables. All are derived from rtl_model/texture/tokens.h
// (field lists) and spec/texture.
//
//   deburr_hdl_headers FOLDER [NAME=VALUE...]
//
// Settings are parameters of the texture unit: they decide some field widths, and are the defaults
// of the units' parameters (CHOSEN_*). Uses macros instead of packages and structures, because only
// these work alike in Verilator, yosys and Icarus Verilog.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/payload.h"
#include "rtl_model/texture/latency_fifo.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/packets.h"
#include "spec/texture/registers.h"
#include "spec/texture/tables.h"
#include "tb/hdl/memory_shape.h"
#include "tb/hdl/settings.h"

namespace {

namespace hw = deburr::rtl::texture;
namespace texture = deburr::spec::texture;
using deburr::rtl::Payload;
using deburr::rtl::PayloadNode;
using deburr::rtl::PayloadShape;

std::string macro(std::string_view name) {
  std::string text;
  for (const char c : name)
    text += c == '.' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

class Header {
 public:
  explicit Header(std::string_view name) : guard_(macro(name) + "_SVH") {
    text_ = fmt::format(
        "// SPDX-License-Identifier: MIT\n// Printed by deburr_hdl_headers; do not edit.\n"
        "`ifndef {0}\n`define {0}\n",
        guard_);
  }
  void define(const std::string& name, std::string_view value) {
    text_ += fmt::format("`define {} {}\n", name, value);
  }
  void define(const std::string& name, std::uint64_t value) { define(name, std::to_string(value)); }
  // Macros for a field: range, lowest and highest bit, width, and the range without the highest
  // bit.
  void range(const std::string& name, std::uint32_t low, std::uint32_t bits) {
    const std::uint32_t top = low + bits - 1;
    define(name, fmt::format("{}:{}", top, low));
    define(name + "_FIRST", low);
    define(name + "_TOP", top);
    define(name + "_BITS", bits);
    if (bits > 1) define(name + "_LOW", fmt::format("{}:{}", top - 1, low));
  }
  void write(const std::filesystem::path& file) const {
    std::ofstream stream(file);
    stream << text_ << "`endif  // " << guard_ << "\n";
    if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
  }

 private:
  std::string guard_, text_;
};

// Macros for the fields below a node and for the node itself, which spans their bits. Returns the
// number of bits.
std::uint32_t ranges(Header& header, const std::string& name, const PayloadNode& node) {
  if (node.kind == PayloadNode::Kind::kField) {
    header.range(name, node.field.first_bit, node.field.bits);
    return node.field.bits;
  }
  const PayloadNode* first = &node;
  while (first->kind != PayloadNode::Kind::kField) first = &first->children.front();
  std::uint32_t bits = 0;
  for (const PayloadNode& child : node.children)
    bits += ranges(header, name + "_" + macro(child.name), child);
  if (!node.name.empty()) header.range(name, first->field.first_bit, bits);
  return bits;
}
template <class T>
void token(Header& header, const std::string& name, const PayloadShape& shape = {}) {
  const Payload payload = Payload::of<T>(shape);
  header.define(name + "_BITS", payload.bits());
  ranges(header, name, payload.node());
}

void print_tokens(const texture::Parameters& configuration, const std::filesystem::path& folder) {
  Header header("tokens");
  token<hw::Ticket>(header, "TICKET");
  token<texture::Quad>(header, "QUAD");
  token<hw::DerivativeToken>(header, "DERIVATIVE_TOKEN");
  token<hw::FootprintToken>(header, "FOOTPRINT_TOKEN", hw::footprint_shape(configuration));
  token<hw::Log2Token>(header, "LOG2_TOKEN", hw::axis_shape(configuration));
  token<hw::LevelToken>(header, "LEVEL_TOKEN", hw::axis_shape(configuration));
  token<hw::SampleToken>(header, "SAMPLE_TOKEN", hw::sample_shape(configuration));
  token<hw::TexelToken>(header, "TEXEL_TOKEN", hw::texel_shape(configuration));
  token<hw::TexelQuadToken>(header, "TEXEL_QUAD_TOKEN", hw::texel_quad_shape(configuration));
  token<texture::Colour>(header, "COLOUR");
  token<hw::MissToken>(header, "MISS_TOKEN", hw::miss_shape(configuration));
  token<hw::CacheToken>(header, "CACHE_TOKEN", hw::cache_shape(configuration));
  token<deburr::rtl::MemoryRequest>(header, "MEMORY_REQUEST",
                                    deburr::tb::hdl::memory_request_shape(configuration));
  token<deburr::rtl::MemoryResponse>(header, "MEMORY_RESPONSE",
                                     deburr::tb::hdl::memory_response_shape(configuration));
  header.write(folder / "tokens.svh");
}

// A constant with the first bit in its lowest place. A concatenation of 4096 entries would be
// nested as deep in some parsers.
std::string number(std::vector<bool> bits) {
  const std::size_t width = bits.size();
  while (bits.size() % 4 != 0) bits.push_back(false);
  std::string digits;
  for (std::size_t i = bits.size(); i > 0; i -= 4)
    digits +=
        fmt::format("{:x}", bits[i - 1] * 8 + bits[i - 2] * 4 + bits[i - 3] * 2 + bits[i - 4]);
  return fmt::format("{}'h{}", width, digits);
}

void print_descriptor(const std::filesystem::path& folder) {
  Header header("descriptor");
  namespace reg = texture::reg;
  const std::uint32_t bases = reg::kLevelBase / 4, words = bases + texture::kMaxLevels;
  // Number of bits used of a size in a valid descriptor.
  const auto used =
      static_cast<std::uint32_t>(std::bit_width(std::uint32_t{texture::kMaxTextureSize}));
  std::vector<bool> kept(std::size_t{words} * 32);
  const auto keep = [&](std::uint32_t first, std::uint32_t bits) {
    std::fill_n(kept.begin() + first, bits, true);
  };
  for (const deburr::spec::RegisterInfo& info : texture::kDescriptorRegisters) {
    header.range(fmt::format("DESCRIPTOR_{}", info.name), info.offset * 8, 32);
    for (const deburr::spec::Field& field : info.fields) {
      const std::uint32_t low = info.offset * 8 + field.low, bits = field.high - field.low + 1u;
      header.range(fmt::format("DESCRIPTOR_{}_{}", info.name, macro(field.name)), low, bits);
      keep(low, info.offset == reg::kSize ? used : bits);
    }
  }
  header.range("DESCRIPTOR_WIDTH_USED", reg::kSize * 8 + reg::size::kWidth.low, used);
  header.range("DESCRIPTOR_HEIGHT_USED", reg::kSize * 8 + reg::size::kHeight.low, used);
  // Of a base the line, and one bit for the bits below it.
  for (std::uint32_t word = bases; word < words; ++word) {
    keep(word * 32, 1);
    keep(word * 32 + 6, 26);
  }
  header.range("DESCRIPTOR_BASE", bases * 32, 32 * std::uint32_t{texture::kMaxLevels});
  header.define("DESCRIPTOR_BASES", std::uint64_t{texture::kMaxLevels});
  header.define("DESCRIPTOR_WORDS", words);
  header.define("DESCRIPTOR_KEPT", number(std::move(kept)));
  header.write(folder / "descriptor.svh");
}

void codes(Header& header, const std::string& name, std::span<const std::string_view> names) {
  for (std::size_t i = 0; i < names.size(); ++i) header.define(name + "_" + macro(names[i]), i);
  header.define(name + "_LAST", names.size() - 1);
}
// One number with entry 0 in its lowest bits.
void table(Header& header, const std::string& name, std::span<const std::uint32_t> entries) {
  const auto bits =
      static_cast<std::uint32_t>(std::bit_width(*std::max_element(entries.begin(), entries.end())));
  std::vector<bool> all;
  for (const std::uint32_t entry : entries)
    for (std::uint32_t bit = 0; bit < bits; ++bit) all.push_back(entry >> bit & 1);
  header.define(name + "_BITS", bits);
  header.define(name, number(std::move(all)));
}
template <class Entries>
void table(Header& header, const std::string& name, const Entries& entries) {
  table(header, name,
        std::span<const std::uint32_t>(std::vector<std::uint32_t>(entries.begin(), entries.end())));
}

// Codes of the options, the chosen ones, and tables.
void print_tables(const texture::Parameters& chosen, const std::filesystem::path& folder) {
  Header header("tables");
  codes(header, "AXES", texture::kAxesNames);
  codes(header, "FOOTPRINT", texture::kFootprintNames);
  codes(header, "LOG2", texture::kLog2Names);
  codes(header, "COUNT", texture::kCountNames);
  codes(header, "CAP", texture::kCountCapNames);
  codes(header, "KERNEL", texture::kKernelNames);
  codes(header, "SRGB_OUTPUT", texture::kSrgbOutputNames);
  codes(header, "REPLACEMENT", texture::kReplacementNames);
  codes(header, "FORMAT", texture::kFormatNames);
  codes(header, "BC", texture::kBlockRuleNames);
  codes(header, "WRAP", texture::kWrapNames);
  codes(header, "MIN_FILTER", texture::kMinFilterNames);
  const auto choose = [&](const char* name, auto value) {
    header.define(std::string("CHOSEN_") + name, static_cast<std::uint64_t>(value));
  };
  choose("AXES", chosen.axes);
  choose("FOOTPRINT", chosen.footprint);
  choose("LOG2", chosen.log2);
  choose("COUNT", chosen.count);
  choose("CAP", chosen.count_cap);
  choose("KERNEL", chosen.kernel);
  choose("SPREAD", chosen.spread);
  choose("AXIS_CYCLES", chosen.axis_cycles);
  choose("SRGB_OUTPUT", chosen.srgb_output);
  choose("BC", chosen.bc);
  choose("CACHE_BYTES", chosen.cache_bytes);
  choose("CACHE_LINE_BYTES", chosen.cache_line_bytes);
  choose("CACHE_WAYS", chosen.cache_ways);
  choose("CACHE_REPLACEMENT", chosen.cache_replacement);
  choose("CACHE_OUTSTANDING", chosen.cache_outstanding);
  // The default, without information about the memory.
  choose("CACHE_FIFO_DEPTH", hw::LatencyFifo::depth(chosen, {}));
  for (std::size_t i = 1; i <= 3; ++i)
    header.define(fmt::format("AXIS_COSINE_{}", i),
                  static_cast<std::uint64_t>(texture::kAxes[i].cosine));
  table(header, "LOG2_TABLE", texture::kLog2Table);
  table(header, "LOG2_CORRECTION", texture::kLog2Correction);
  table(header, "LOG2_COUNT", texture::kLog2Count);
  table(header, "RECIPROCAL", texture::kReciprocal);
  table(header, "SRGB_TO_LINEAR", texture::kSrgbToLinear);
  table(header, "LINEAR_TO_SRGB", texture::kLinearToSrgb);
  // ETC2. The negative modifiers of alpha are the complements of the positive ones.
  std::vector<std::uint32_t> modifiers, positives;
  for (const auto& pair : texture::kEtcModifiers)
    modifiers.insert(modifiers.end(), pair.begin(), pair.end());
  for (const auto& row : texture::kEacModifiers)
    positives.insert(positives.end(), row.begin() + 4, row.end());
  table(header, "ETC_MODIFIERS", modifiers);
  table(header, "ETC_DISTANCES", texture::kEtcDistances);
  table(header, "EAC_POSITIVES", positives);
  // Indexed by N - 1 and sample.
  std::vector<std::uint32_t> weights;
  const auto& kernel = texture::kKernelWeights[static_cast<std::size_t>(chosen.kernel)];
  for (std::size_t n = 1; n < kernel.size(); ++n)
    weights.insert(weights.end(), kernel[n].begin(), kernel[n].end());
  table(header, "KERNEL_WEIGHTS", weights);
  header.write(folder / "tables.svh");
}

}  // namespace

int main(int count, char** arguments) {
  const std::vector<std::string> given(arguments + 1, arguments + count);
  if (given.empty()) {
    std::cerr << "usage: deburr_hdl_headers FOLDER [NAME=VALUE...]\n";
    return 2;
  }
  try {
    std::string settings;
    for (std::size_t i = 1; i < given.size(); ++i) settings += given[i] + " ";
    const texture::Parameters parameters = deburr::tb::hdl::parameters_of(settings);
    std::filesystem::create_directories(given[0]);
    print_tokens(parameters, given[0]);
    print_descriptor(given[0]);
    print_tables(parameters, given[0]);
  } catch (const std::exception& error) {
    std::cerr << "deburr_hdl_headers: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
