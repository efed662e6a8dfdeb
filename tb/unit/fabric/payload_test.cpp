// SPDX-License-Identifier: MIT
// Payloads by field: widths, values, faults, texts, poison and types.
#include "rtl_model/fabric/payload.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>

#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/memory_port.h"
#include "tb/unit/fabric/support.h"
#include "tb/unit/rtl/formats.h"

namespace deburr::tb::payload_test {
namespace {

using rtl::Payload;
using rtl::PayloadShape;
using testing::AllOf;
using testing::HasSubstr;

enum class Colour : std::uint8_t { kRed, kGreen, kBlue };

struct Place {
  std::uint16_t row, column;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("row", self.row, 14, "U14");
    visit("column", self.column, 13, "U13");
  }
  friend bool operator==(const Place&, const Place&) = default;
};

struct Beat {
  Place place{};
  std::array<std::array<std::uint8_t, 4>, 4> pixel{};
  std::array<Place, 2> corner{};
  std::int32_t slope = 0;
  std::int64_t wide = 0;
  std::uint8_t edges = 0;
  Colour colour = Colour::kRed;
  bool last = false;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("place", self.place);
    visit.lanes("pixel", self.pixel, 8, "U0.8", "rgba");
    visit("corner", self.corner);
    visit("slope", self.slope, 13, "S0.12");
    visit("wide", self.wide, 33, "S8.24");
    visit.lane_bits("edges", self.edges, 4);
    visit("colour", self.colour, 2);
    visit("last", self.last);
  }
  friend bool operator==(const Beat&, const Beat&) = default;
};

// By hand: 14 + 13, 4 x 4 x 8, 2 x 27, 13, 33, 4, 2, 1.
static_assert(rtl::kPayloadBits<Beat> == 27 + 128 + 54 + 13 + 33 + 4 + 2 + 1);
static_assert(rtl::kPayloadBits<Place> == 27);
static_assert(rtl::kPayloadBits<bool> == 1 && rtl::kPayloadBits<std::int16_t> == 16);
static_assert(rtl::HasFields<Beat> && !rtl::HasFields<int>);

template <class T>
std::byte* bytes(T& value) {
  return reinterpret_cast<std::byte*>(&value);
}

TEST(Payload, WidthIsSumOfBuiltFields) {
  EXPECT_EQ(Payload::of<Beat>().bits(), 262U);
  EXPECT_EQ(Payload::of<Beat>({.lanes = 2}).bits(), 262U - 64 - 2);
  EXPECT_EQ(Payload::of<Beat>({.lanes = 1, .widths = {{"place.column", 5}, {"corner", 10}}}).bits(),
            262U - 96 - 3 - 8 - (3 + 4) * 2);
  EXPECT_EQ(Payload::of<std::uint16_t>().bits(), 16U);
  EXPECT_EQ(rtl::Link<Beat>("link", 2, {.lanes = 2}).payload_bits(), 196U);
  EXPECT_EQ(rtl::Fifo<Beat>("fifo", 4).word_bits(), 262U);
  EXPECT_THROW(Payload::of<Beat>({.widths = {{"slope", 14}}}), spec::CheckFailed);
  EXPECT_THROW(Payload::of<Beat>({.widths = {{"slop", 4}}}), spec::CheckFailed);
  EXPECT_EQ(Payload::of<Beat>({.counts = {{"corner", 1}}}).bits(), 262U - 27);
  for (const char* const no_array : {"corners", "slope", "edges", "place", "corner.0"})
    EXPECT_THROW(Payload::of<Beat>({.counts = {{no_array, 1}}}), spec::CheckFailed) << no_array;
  EXPECT_THROW(Payload::of<Beat>({.counts = {{"corner", 3}}}), spec::CheckFailed);
  EXPECT_THROW(Payload::of<Beat>({.counts = {{"corner", 0}}}), spec::CheckFailed);
  EXPECT_THROW(Payload::of<Beat>({.lanes = 5}), spec::CheckFailed);
  EXPECT_EQ(Payload::of<Place>({.lanes = 5}).bits(), 27U);  // no field per lane
}

// The fields of the only element stand in the container, without the array's name.
TEST(Payload, SingleElementHasNoIndex) {
  const Payload payload = Payload::of<Beat>({.single = "corner"});
  EXPECT_EQ(payload.bits(), 262U - 27);
  EXPECT_NE(payload.find("column"), nullptr);
  EXPECT_EQ(payload.find("corner.0.column"), nullptr);
  for (const char* const no_array : {"corners", "slope", "edges", "place", "corner.0"})
    EXPECT_THROW(Payload::of<Beat>({.single = no_array}), spec::CheckFailed) << no_array;
}

// Width 0: the engine is built without the field. It has no bit, no wave, no fault and no entry in
// the types, and its value in the model is ignored.
TEST(Payload, FieldOfWidthZeroIsNotBuilt) {
  const PayloadShape without = {.widths = {{"slope", 0}, {"place.row", 0}, {"edges", 0}}};
  const Payload payload = Payload::of<Beat>(without);
  EXPECT_EQ(payload.bits(), 262U - 13 - 14 - 4);
  for (const char* const gone : {"slope", "place.row", "edges"}) {
    EXPECT_EQ(payload.find(gone), nullptr) << gone;
    EXPECT_THAT(text_of<spec::ConfigError>([&] { payload.bit(gone); }), HasSubstr("unknown field"));
  }
  // The fields after it move up.
  EXPECT_EQ(payload.find("place.column")->first_bit, 0U);
  EXPECT_EQ(payload.find("pixel.0.r")->first_bit, 13U);
  EXPECT_EQ(payload.find("wide")->first_bit, 13U + 128 + 54);
  EXPECT_EQ(payload.find("colour")->first_bit, 13U + 128 + 54 + 33);

  Beat beat;
  beat.slope = 77777;  // does not fit in 13 bits
  beat.place.row = 0xFFFF;
  beat.edges = 0xFF;
  EXPECT_EQ(payload.misfit(bytes(beat)), nullptr);
  EXPECT_NE(Payload::of<Beat>().misfit(bytes(beat)), nullptr);
  EXPECT_THAT(payload.text(bytes(beat)), testing::Not(HasSubstr("slope")));
  // Noise and every fault leave it unchanged.
  const Beat before = beat;
  payload.fill(bytes(beat), 5);
  for (std::uint32_t n = 0; n < payload.bits(); ++n)
    payload.flip(bytes(beat), payload.bit(std::to_string(n)));
  EXPECT_EQ(beat.slope, before.slope);
  EXPECT_EQ(beat.place.row, before.place.row);
  EXPECT_EQ(beat.edges, before.edges);
  EXPECT_NE(beat.wide, before.wide);
  EXPECT_THROW(payload.bit(std::to_string(payload.bits())), spec::ConfigError);

  EXPECT_EQ(rtl::Link<Beat>("link", 2, without).payload_bits(), 231U);
  EXPECT_EQ(rtl::Fifo<Beat>("fifo", 4, without).word_bits(), 231U);
}

TEST(Payload, ArrayElementsAreAllBuiltOrNone) {
  const PayloadShape without = {.widths = {{"corner.0.row", 0}, {"corner.1.row", 0}}};
  const Payload payload = Payload::of<Beat>(without);
  EXPECT_EQ(payload.bits(), 262U - 28);
  EXPECT_EQ(payload.find("corner.1.row"), nullptr);
  EXPECT_NE(payload.find("corner.1.column"), nullptr);
  EXPECT_THAT(text_of<spec::CheckFailed>([] {
                Payload::of<Beat>({.widths = {{"corner.1.row", 0}}});
              }),
              HasSubstr("all of corner"));
  // An unknown field cannot be omitted.
  EXPECT_THROW(Payload::of<Beat>({.widths = {{"slop", 0}}}), spec::CheckFailed);
}

TEST(Payload, PackageOmitsFieldsOfWidthZero) {
  const Payload place = Payload::of<Place>({.widths = {{"row", 0}}});
  const std::array<const Payload*, 1> all = {&place};
  EXPECT_EQ(rtl::payload_package("tokens_pkg", all),
            "// SPDX-License-Identifier: MIT\n"
            "package tokens_pkg;\n"
            "\n"
            "  // 13 bits\n"
            "  typedef struct packed {\n"
            "    logic [12:0] column;  // U13\n"
            "  } place_t;\n"
            "\n"
            "endpackage\n");
}

TEST(Payload, ArrayElementsHaveEqualWidths) {
  EXPECT_EQ(Payload::of<Beat>({.widths = {{"corner.0.row", 4}, {"corner.1.row", 4}}}).bits(),
            262U - 20);
  EXPECT_THAT(text_of<spec::CheckFailed>([] {
                Payload::of<Beat>({.widths = {{"corner.1.row", 4}}});
              }),
              HasSubstr("narrow all of corner"));
  EXPECT_THROW(Payload::of<Beat>({.widths = {{"pixel.2.g", 7}}}), spec::CheckFailed);
}

struct OneName {
  std::uint8_t a = 0, b = 0;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("a", self.a, 8);
    visit("a", self.b, 8);
  }
};
struct OnePlace {
  std::uint8_t a = 0, b = 0;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("a", self.a, 8);
    visit("b", self.a, 8);
  }
};

struct OneBitMore {
  std::uint32_t area = 0;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("area", self.area, 31, "U14.16");
  }
};

struct NoSign {
  std::int32_t area = 0;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("area", self.area, 30, "S14.16");
  }
};

TEST(Payload, FormatHasAsManyBitsAsField) {
  EXPECT_THAT(text_of<spec::CheckFailed>([] { Payload::of<OneBitMore>(); }),
              HasSubstr("area: format U14.16 has 30 bits, but 31 are listed"));
  EXPECT_THAT(text_of<spec::CheckFailed>([] { Payload::of<NoSign>(); }),
              HasSubstr("area: format S14.16 has 31 bits, but 30 are listed"));
}

// Formats are Ua.b and Sa.b; similar texts are not formats.
struct OtherTexts {
  std::uint8_t a = 0, b = 0, c = 0, d = 0, e = 0, f = 0, g = 0;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("a", self.a, 5, "U.8");
    visit("b", self.b, 5, "U8");
    visit("c", self.c, 5, "U0.8 or so");
    visit("d", self.d, 5, "S");
    visit("e", self.e, 5, "");
    visit("f", self.f, 5, "U8x5");
    visit("g", self.g, 5, "Q0.8");
  }
};

TEST(Payload, TextThatIsNotFormatGivesNoWidth) { EXPECT_EQ(Payload::of<OtherTexts>().bits(), 35U); }

// A type name in another style, with any letters.
struct AZaz09 {
  std::uint8_t a = 0;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("a", self.a, 8);
  }
};
struct Zero0Z9 {
  std::uint8_t a = 0;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("a", self.a, 8);
  }
};

template <int kNumber>
struct Numbered {
  std::uint8_t a = 0;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("a", self.a, 8);
  }
};

TEST(Payload, TypesAreNamedInLowerCase) {
  EXPECT_EQ(Payload::of<Numbered<7>>().node().type, "numbered_7__t");
  EXPECT_EQ(Payload::of<AZaz09>().node().type, "a_zaz09_t");
  EXPECT_EQ(Payload::of<Zero0Z9>().node().type, "zero0_z9_t");
}

// Five bits of each C++ type that can hold them.
struct FiveBits {
  std::int8_t s8 = 0;
  std::int16_t s16 = 0;
  std::int32_t s32 = 0;
  std::int64_t s64 = 0;
  std::uint8_t u8 = 0;
  std::uint64_t u64 = 0;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("s8", self.s8, 5);
    visit("s16", self.s16, 5);
    visit("s32", self.s32, 5);
    visit("s64", self.s64, 5);
    visit("u8", self.u8, 5);
    visit("u64", self.u64, 5);
  }
};

TEST(Payload, ValueFitsForEveryType) {
  const Payload payload = Payload::of<FiveBits>();
  const auto misfits = [&](int value) {
    std::string names;
    for (const rtl::Field& field : payload.fields()) {
      FiveBits beat;
      if (field.name == "s8") beat.s8 = static_cast<std::int8_t>(value);
      if (field.name == "s16") beat.s16 = static_cast<std::int16_t>(value);
      if (field.name == "s32") beat.s32 = value;
      if (field.name == "s64") beat.s64 = value;
      if (field.name == "u8") beat.u8 = static_cast<std::uint8_t>(value);
      if (field.name == "u64") beat.u64 = static_cast<std::uint64_t>(value);
      if (payload.misfit(bytes(beat)) != nullptr) names += field.name + " ";
    }
    return names;
  };
  for (const int value : {0, 1, 15}) EXPECT_EQ(misfits(value), "") << value;
  for (const int value : {16, 31}) EXPECT_EQ(misfits(value), "s8 s16 s32 s64 ") << value;
  for (const int value : {-1, -16}) EXPECT_EQ(misfits(value), "u8 u64 ") << value;
  for (const int value : {-17, -32, -128, 32, 64, 127})
    EXPECT_EQ(misfits(value), "s8 s16 s32 s64 u8 u64 ") << value;
}

TEST(Payload, NumberHasItsSign) {
  const Payload payload = Payload::of<FiveBits>();
  for (const int value : {-16, -9, -8, -1, 0, 7, 8, 15}) {
    FiveBits beat;
    beat.s8 = static_cast<std::int8_t>(value);
    beat.s64 = value;
    beat.u8 = static_cast<std::uint8_t>(value & 31);
    EXPECT_EQ(payload.find("s8")->text(bytes(beat)), std::to_string(value));
    EXPECT_EQ(payload.find("s64")->text(bytes(beat)), std::to_string(value));
    EXPECT_EQ(payload.find("u8")->text(bytes(beat)), std::to_string(value & 31));
  }
}

TEST(Payload, BitIsWholeNumber) {
  const Payload payload = Payload::of<FiveBits>();
  EXPECT_EQ(payload.bit("7").field->name, "s16");
  EXPECT_EQ(payload.bit("s16.2").bit, 2U);
  for (const char* const text : {"7x", "s16.2x", "s16.", "", "-1", "s16.5", "30"})
    EXPECT_THROW(payload.bit(text), spec::ConfigError) << text;
}

TEST(Payload, EachFieldHasUniqueNameAndPosition) {
  EXPECT_THAT(text_of<spec::CheckFailed>([] { Payload::of<OneName>(); }),
              HasSubstr("a and a: two fields with the same name"));
  EXPECT_THAT(text_of<spec::CheckFailed>([] { Payload::of<OnePlace>(); }),
              AllOf(HasSubstr("same offset"), HasSubstr("b")));
}

// The noise of a slot: a forgotten value differs from its neighbours and from the previous slot.
TEST(Payload, NoiseDependsOnField) {
  const Payload payload = Payload::of<Beat>();
  Beat one, other;
  payload.fill(bytes(one), 1);
  payload.fill(bytes(other), 2);
  EXPECT_EQ(payload.misfit(bytes(one)), nullptr);
  EXPECT_NE(one.place, one.corner[0]);
  EXPECT_NE(one.corner[0], one.corner[1]);
  EXPECT_NE(one.pixel[0], one.pixel[1]);
  EXPECT_NE(one.pixel[0][0], one.pixel[0][1]);
  EXPECT_NE(one.place, other.place);
  EXPECT_NE(one.slope, other.slope);
}

// By hand: 32 + 5 + 7 + 1 + 32 + 32 x 8, and 32 + 5 + 6 + 1 + 1 + 2 + 32 x 8.
TEST(Payload, MemoryBeatsHaveWidthOfTheirPort) {
  rtl::MemoryPortParameters port;
  port.line_bytes = 32;
  EXPECT_EQ(Payload::of<rtl::MemoryRequest>(rtl::request_shape(port, 32, 5)).bits(), 333U);
  EXPECT_EQ(Payload::of<rtl::MemoryResponse>(rtl::response_shape(port, 32, 5)).bits(), 303U);
  EXPECT_EQ(rtl::kPayloadBits<rtl::MemoryRequest>, 64U + 32 + 7 + 1 + 64 + 512);
  // Without constant fields: 32 + 5 + 7, and 32 + 5 + 6 + 1 + 2 + 32 x 8.
  port.read_only = true;
  const Payload request = Payload::of<rtl::MemoryRequest>(rtl::request_shape(port, 32, 5));
  EXPECT_EQ(request.bits(), 44U);
  EXPECT_EQ(request.find("data.0"), nullptr);
  EXPECT_EQ(Payload::of<rtl::MemoryResponse>(rtl::response_shape(port, 32, 5)).bits(), 302U);
}

TEST(Payload, MemoryBeatsHaveBitsOfTheirFormats) {
  EXPECT_GE((expect_widths_of_formats<rtl::MemoryRequest, rtl::MemoryResponse>()), 7);
}

TEST(Payload, FieldsHaveTheirPositions) {
  const Payload payload = Payload::of<Beat>();
  ASSERT_NE(payload.find("pixel.3.b"), nullptr);
  EXPECT_EQ(payload.find("pixel.3.b")->first_bit, 27U + 3 * 32 + 2 * 8);
  EXPECT_EQ(payload.find("pixel.3.b")->format, "U0.8");
  EXPECT_EQ(payload.find("corner.1.row")->bits, 14U);
  EXPECT_EQ(payload.find("pixel"), nullptr);
  Beat beat;
  beat.pixel[3][2] = 77;
  beat.slope = -5;
  beat.wide = -(std::int64_t{1} << 32);
  EXPECT_EQ(payload.find("pixel.3.b")->get(bytes(beat)), 77U);
  EXPECT_EQ(payload.find("slope")->get(bytes(beat)), 0x1FFBU);
  EXPECT_EQ(payload.find("slope")->text(bytes(beat)), "-5");
  EXPECT_EQ(payload.find("wide")->text(bytes(beat)), "-4294967296");
  payload.find("slope")->set(bytes(beat), 0x1000);
  EXPECT_EQ(beat.slope, -4096);
  EXPECT_EQ(payload.misfit(bytes(beat)), nullptr);
  for (const std::int32_t slope : {4096, -4097}) {
    beat.slope = slope;
    ASSERT_NE(payload.misfit(bytes(beat)), nullptr);
    EXPECT_EQ(payload.misfit(bytes(beat))->name, "slope");
  }
  beat.slope = 4095;
  EXPECT_EQ(payload.misfit(bytes(beat)), nullptr);
  beat.place.column = 1 << 13;
  EXPECT_EQ(payload.misfit(bytes(beat))->name, "place.column");
}

TEST(Payload, EveryBitIsFlippedByNumberAndName) {
  const Payload payload = Payload::of<Beat>();
  const Beat zero;
  for (std::uint32_t n = 0; n < payload.bits(); ++n) {
    Beat beat;
    payload.flip(bytes(beat), payload.bit(std::to_string(n)));
    EXPECT_FALSE(beat == zero) << n;
    EXPECT_EQ(payload.misfit(bytes(beat)), nullptr);
    payload.flip(bytes(beat), payload.bit(std::to_string(n)));
    EXPECT_EQ(beat, zero) << n;
  }
  const auto bit = [&](const char* text) {
    const Payload::Bit found = payload.bit(text);
    return found.field->name + "[" + std::to_string(found.bit) + "]";
  };
  EXPECT_EQ(bit("pixel.0.r"), "pixel.0.r[0]");
  EXPECT_EQ(bit("pixel.0.r.7"), "pixel.0.r[7]");
  EXPECT_EQ(bit("0"), "place.row[0]");
  EXPECT_EQ(bit("26"), "place.column[12]");
  EXPECT_EQ(bit("27"), "pixel.0.r[0]");
  EXPECT_EQ(bit("261"), "last[0]");
  EXPECT_THAT(text_of<spec::ConfigError>([&] { bit("262"); }),
              HasSubstr("the payload has 262 bits"));
  EXPECT_THAT(text_of<spec::ConfigError>([&] { bit("pixel.0.r.8"); }),
              HasSubstr("no bit 8 of pixel.0.r: the field has 8"));
  EXPECT_THAT(text_of<spec::ConfigError>([&] { bit("pixel.9.r"); }),
              AllOf(HasSubstr("unknown field pixel.9.r"), HasSubstr("\n  slope (13 bits)")));
}

TEST(Payload, DifferenceNamesTheFields) {
  Beat expected, got;
  expected.pixel[1][0] = 17;
  got.pixel[1][0] = 18;
  got.slope = -3;
  EXPECT_EQ(rtl::payload_difference(expected, got), "pixel.1.r=17/18 slope=0/-3");
  EXPECT_EQ(rtl::payload_difference(expected, expected), "");
  EXPECT_THAT(rtl::payload_text(expected), AllOf(HasSubstr("pixel.1.r=17 "), HasSubstr("last=0")));
}

enum class Step { kUp, kDown, kLeft, kRight };  // an int in C++
struct Reserved {
  Step before = Step::kUp;
  std::array<bool, 2> input{};
  bool inputs = false;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("before", self.before, 2);
    visit("input", self.input, 1);
    visit("inputs", self.inputs);
  }
};

TEST(Payload, EnumerationIsUnsigned) {
  const Payload payload = Payload::of<Reserved>();
  Reserved reserved{Step::kRight};
  EXPECT_EQ(payload.misfit(bytes(reserved)), nullptr);
  EXPECT_THAT(payload.text(bytes(reserved)), HasSubstr("before=3"));
  payload.flip(bytes(reserved), payload.bit("before.0"));
  EXPECT_EQ(reserved.before, Step::kLeft);
  reserved.before = Step{4};
  ASSERT_NE(payload.misfit(bytes(reserved)), nullptr);
  EXPECT_EQ(payload.misfit(bytes(reserved))->name, "before");
}

TEST(Payload, PackageIsValidAndHasIntegers) {
  const Payload reserved = Payload::of<Reserved>(), number = Payload::of<std::uint16_t>(),
                again = Payload::of<std::uint16_t>(), sign = Payload::of<std::int32_t>(),
                bit = Payload::of<bool>();
  const std::array<const Payload*, 5> all = {&reserved, &number, &again, &sign, &bit};
  EXPECT_EQ(rtl::payload_package("words_pkg", all),
            "// SPDX-License-Identifier: MIT\n"
            "package words_pkg;\n"
            "\n"
            "  // 5 bits\n"
            "  typedef struct packed {\n"
            "    logic inputs;\n"
            "    logic [1:0] input_;\n"
            "    logic [1:0] before_;\n"
            "  } reserved_t;\n"
            "\n"
            "  // 16 bits\n"
            "  typedef logic [15:0] u16_t;\n"
            "\n"
            "  // 32 bits\n"
            "  typedef logic signed [31:0] s32_t;\n"
            "\n"
            "  // 1 bits\n"
            "  typedef logic u1_t;\n"
            "\n"
            "endpackage\n");
}

TEST(Payload, PackageDeclaresItsContents) {
  const Payload beat = Payload::of<Beat>({.lanes = 2}), place = Payload::of<Place>(),
                narrow = Payload::of<Place>({.widths = {{"row", 4}}});
  const std::array<const Payload*, 3> all = {&beat, &place, &narrow};
  EXPECT_EQ(rtl::payload_package("tokens_pkg", all),
            "// SPDX-License-Identifier: MIT\n"
            "package tokens_pkg;\n"
            "\n"
            "  // 27 bits\n"
            "  typedef struct packed {\n"
            "    logic [12:0] column;  // U13\n"
            "    logic [13:0] row;  // U14\n"
            "  } place_t;\n"
            "\n"
            "  // 196 bits\n"
            "  typedef struct packed {\n"
            "    logic last;\n"
            "    logic [1:0] colour;\n"
            "    logic [1:0] edges;  // one bit per lane\n"
            "    logic signed [32:0] wide;  // S8.24\n"
            "    logic signed [12:0] slope;  // S0.12\n"
            "    place_t [1:0] corner;\n"
            "    logic [1:0][3:0][7:0] pixel;  // U0.8\n"
            "    place_t place;\n"
            "  } beat_t;\n"
            "\n"
            "  // 17 bits\n"
            "  typedef struct packed {\n"
            "    logic [12:0] column;  // U13\n"
            "    logic [3:0] row;  // U14\n"
            "  } place_2_t;\n"
            "\n"
            "endpackage\n");
}

}  // namespace
}  // namespace deburr::tb::payload_test
