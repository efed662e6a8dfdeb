// SPDX-License-Identifier: MIT
// The register block: access rules, TLM errors, generated texts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tlm_utils/simple_initiator_socket.h>

#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/fabric/register_block.h"
#include "rtl_model/fabric/register_section.h"
#include "rtl_model/platform/register_host.h"
#include "spec/error.h"

namespace deburr::tb::registers_test {
namespace {

using spec::Access;

enum Index { kControl, kStatus, kCommand, kFlags, kCount };
constexpr std::array kControlField = spec::number(Access::kReadWrite, 5),
                     kStatusField = spec::number(Access::kReadOnly, 1),
                     kCommandField = spec::number(Access::kWriteOnly),
                     kFlagsField = spec::number(Access::kWriteOneToClear);
constexpr spec::RegisterInfo kTable[] = {
    {0x00, "CONTROL", "bit 0: enable; bits 2..1: mode", kControlField},
    {0x04, "STATUS", "bit 0: idle", kStatusField},
    {0x08, "COMMAND", "bit 0: start", kCommandField},
    {0x10, "FLAGS", "bit i: error i was seen", kFlagsField},
    {0x14, "COUNT", "lines fetched, low word", spec::kCounter},
};

struct Bus : sc_core::sc_module {
  tlm_utils::simple_initiator_socket<Bus> socket{"socket"};
  rtl::RegisterBlock block{"block", kTable};
  std::uint32_t word = 0;
  std::uint32_t enables = 0xFFFFFFFF;
  unsigned length = 4, width = 4;
  bool with_enables = false;

  explicit Bus(const sc_core::sc_module_name& name) : sc_module(name) { socket.bind(block.bus); }

  tlm::tlm_response_status access(tlm::tlm_command command, std::uint64_t address) {
    tlm::tlm_generic_payload payload;
    payload.set_command(command);
    payload.set_address(address);
    payload.set_data_ptr(reinterpret_cast<unsigned char*>(&word));
    payload.set_data_length(length);
    payload.set_streaming_width(width);
    if (with_enables) {
      payload.set_byte_enable_ptr(reinterpret_cast<unsigned char*>(&enables));
      payload.set_byte_enable_length(4);
    }
    sc_core::sc_time delay;
    socket->b_transport(payload, delay);
    return payload.get_response_status();
  }
  tlm::tlm_response_status read(std::uint64_t address) {
    return access(tlm::TLM_READ_COMMAND, address);
  }
  tlm::tlm_response_status write(std::uint64_t address, std::uint32_t value) {
    word = value;
    return access(tlm::TLM_WRITE_COMMAND, address);
  }
};

class Registers : public testing::Test {
 protected:
  Registers() { sc_core::sc_start(sc_core::SC_ZERO_TIME); }
  Bus bus{"bus"};
};

TEST_F(Registers, SupportReadAndWrite) {
  EXPECT_EQ(bus.read(0), tlm::TLM_OK_RESPONSE);
  EXPECT_EQ(bus.word, 5U);
  EXPECT_EQ(bus.write(0, 0x12345678), tlm::TLM_OK_RESPONSE);
  EXPECT_EQ(bus.block.get(kControl), 0x12345678U);
  bus.block.reset();
  EXPECT_EQ(bus.block.get(kControl), 5U);
}

// Each field as declared, in one register: bits of other fields, and undefined bits, stay 0.
TEST(RegisterFields, WriteReachesWritableFieldsOnly) {
  static constexpr spec::Field kEach[] = {
      {"rw", 3, 0, Access::kReadWrite, {}, {}, 5},       {"ro", 7, 4, Access::kReadOnly, {}, {}, 6},
      {"constant", 11, 8, Access::kConstant, {}, {}, 7}, {"shared", 15, 12, Access::kShared, {}},
      {"sticky", 19, 16, Access::kWriteOneToClear, {}},  {"go", 20, 20, Access::kCommand, {}}};
  static constexpr spec::RegisterInfo table[] = {{0, "MIXED", "all kinds", kEach}};
  rtl::RegisterBlock block("block", table);
  platform::RegisterHost host("host");
  host.bus.bind(block.bus);
  sc_core::sc_start(sc_core::SC_ZERO_TIME);
  EXPECT_EQ(host.read(0), 0x765u);
  std::uint32_t seen = 0;
  block.on_write(0, [&](std::uint32_t value) { seen = value; });
  host.write(0, ~std::uint32_t{0});
  EXPECT_EQ(seen, ~std::uint32_t{0});
  EXPECT_EQ(host.read(0), 0xF76Fu);
  block.set(0, 0xF'F76Fu);  // hardware sets the sticky bits
  host.write(0, 0x5'0000u);
  EXPECT_EQ(host.read(0), 0xA'0760u);
}

TEST_F(Registers, ShowCounters) {
  rtl::Counter counter("counter", "lines", "lines fetched");
  counter += 0x1'0000'0007;
  bus.block.show(kCount, counter);
  EXPECT_EQ(bus.read(0x14), tlm::TLM_OK_RESPONSE);
  EXPECT_EQ(bus.word, 7U);
  bus.block.show(kCount, counter, 32);
  bus.read(0x14);
  EXPECT_EQ(bus.word, 1U);
  EXPECT_THROW(bus.block.show(kControl, counter), spec::CheckFailed);
}

TEST_F(Registers, EachMisuseHasItsError) {
  EXPECT_EQ(bus.read(0x0C), tlm::TLM_ADDRESS_ERROR_RESPONSE);  // an unused address
  EXPECT_EQ(bus.read(0x18), tlm::TLM_ADDRESS_ERROR_RESPONSE);
  EXPECT_EQ(bus.read(0x02), tlm::TLM_ADDRESS_ERROR_RESPONSE);
  EXPECT_EQ(bus.read(~std::uint64_t{3}), tlm::TLM_ADDRESS_ERROR_RESPONSE);
  EXPECT_EQ(bus.write(0x04, 0), tlm::TLM_COMMAND_ERROR_RESPONSE);
  EXPECT_EQ(bus.block.get(kStatus), 1U);
  EXPECT_EQ(bus.read(0x08), tlm::TLM_COMMAND_ERROR_RESPONSE);
  bus.with_enables = true;
  EXPECT_EQ(bus.write(0, 9), tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
  bus.with_enables = false;
  bus.length = 2;
  EXPECT_EQ(bus.write(0, 9), tlm::TLM_BURST_ERROR_RESPONSE);
  bus.length = 4;
  for (const unsigned width : {1U, 3U}) {
    bus.width = width;
    EXPECT_EQ(bus.write(0, 9), tlm::TLM_BURST_ERROR_RESPONSE) << width;
  }
  EXPECT_EQ(bus.block.get(kControl), 5U);  // none of these writes took effect
  bus.width = 4;
  EXPECT_EQ(bus.access(tlm::TLM_IGNORE_COMMAND, 0), tlm::TLM_OK_RESPONSE);
}

TEST_F(Registers, DebugTransportStopsAtUnusedAddress) {
  std::uint32_t words[4] = {1, 2, 3, 4};
  tlm::tlm_generic_payload payload;
  payload.set_command(tlm::TLM_WRITE_COMMAND);
  payload.set_address(0);
  payload.set_data_ptr(reinterpret_cast<unsigned char*>(words));
  payload.set_data_length(16);
  EXPECT_EQ(bus.socket->transport_dbg(payload),
            12U);  // including registers that the bus may not write
  EXPECT_EQ(bus.block.get(kStatus), 2U);
  std::memset(words, 0, sizeof words);
  payload.set_command(tlm::TLM_READ_COMMAND);
  EXPECT_EQ(bus.socket->transport_dbg(payload), 12U);
  EXPECT_EQ(words[2], 3U);
  // One word and no byte beyond it; less than one word transfers nothing.
  words[0] = words[1] = 0x55555555;
  payload.set_address(4);
  payload.set_data_length(4);
  EXPECT_EQ(bus.socket->transport_dbg(payload), 4U);
  EXPECT_EQ(words[0], 2U);
  EXPECT_EQ(words[1], 0x55555555U);
  payload.set_data_length(3);
  EXPECT_EQ(bus.socket->transport_dbg(payload), 0U);
  payload.set_address(0x100);
  EXPECT_EQ(bus.socket->transport_dbg(payload), 0U);
}

TEST_F(Registers, DebugWriteHasItsOwnAction) {
  std::vector<std::uint32_t> by_bus, by_debug;
  bus.block.on_write(kCommand, [&](std::uint32_t value) { by_bus.push_back(value); });
  bus.block.on_debug_write(kCommand, [&](std::uint32_t value) { by_debug.push_back(value); });
  std::uint32_t word = 6;
  tlm::tlm_generic_payload payload;
  payload.set_command(tlm::TLM_WRITE_COMMAND);
  payload.set_address(8);
  payload.set_data_ptr(reinterpret_cast<unsigned char*>(&word));
  payload.set_data_length(4);
  EXPECT_EQ(bus.socket->transport_dbg(payload), 4U);
  payload.set_command(tlm::TLM_READ_COMMAND);
  EXPECT_EQ(bus.socket->transport_dbg(payload), 4U);
  EXPECT_EQ(bus.write(8, 7), tlm::TLM_OK_RESPONSE);
  EXPECT_THAT(by_debug, testing::ElementsAre(6));
  EXPECT_THAT(by_bus, testing::ElementsAre(7));
}

// Software that runs ahead of simulated time.
struct Ahead : sc_core::sc_module {
  tlm_utils::simple_initiator_socket<Ahead> socket{"socket"};
  std::vector<std::string> written;  // time of the write, time of its end, remaining delay
  sc_core::sc_time took_effect;
  sc_core::sc_event never;
  SC_HAS_PROCESS(Ahead);
  explicit Ahead(const sc_core::sc_module_name& name) : sc_module(name) { SC_THREAD(run); }
  // Returns the delay that the access gives back.
  sc_core::sc_time write(const sc_core::sc_time& ahead) {
    std::uint32_t word = 7;
    tlm::tlm_generic_payload payload;
    payload.set_command(tlm::TLM_WRITE_COMMAND);
    payload.set_address(8);
    payload.set_data_ptr(reinterpret_cast<unsigned char*>(&word));
    payload.set_data_length(4);
    payload.set_streaming_width(4);
    sc_core::sc_time delay = ahead;
    socket->b_transport(payload, delay);
    return delay;
  }
  void run() {
    for (const int ns : {0, 30, 5}) {
      const sc_core::sc_time delay = write(sc_core::sc_time(ns, sc_core::SC_NS));
      written.push_back(took_effect.to_string() + ", " + sc_core::sc_time_stamp().to_string() +
                        ", " + delay.to_string());
    }
    // The leak check reads the stack of the last process, so the process must not end.
    wait(never);
  }
};

TEST(RegisterTime, ThreadAheadOfTimeWaitsForItsAccess) {
  rtl::RegisterBlock block("block", kTable);
  Ahead ahead("ahead");
  ahead.socket.bind(block.bus);
  block.on_write(kCommand, [&](std::uint32_t) { ahead.took_effect = sc_core::sc_time_stamp(); });
  sc_core::sc_start(sc_core::sc_time(100, sc_core::SC_NS));
  EXPECT_THAT(ahead.written,
              testing::ElementsAre("0 s, 0 s, 0 s", "30 ns, 30 ns, 0 s", "35 ns, 35 ns, 0 s"));
  // A call from outside a process cannot wait: it completes at once and the delay stays with the
  // caller.
  EXPECT_EQ(ahead.write(sc_core::sc_time(30, sc_core::SC_NS)),
            sc_core::sc_time(30, sc_core::SC_NS));
  EXPECT_EQ(ahead.took_effect, sc_core::sc_time(100, sc_core::SC_NS));
}

// Approximately timed: BEGIN_REQ, and the response arrives by a call.
struct NonBlocking : sc_core::sc_module, tlm::tlm_mm_interface {
  tlm_utils::simple_initiator_socket<NonBlocking> socket{"socket"};
  std::vector<tlm::tlm_response_status> responses;
  std::uint32_t word = 0, enables = ~std::uint32_t{0};
  tlm::tlm_generic_payload payload{this};
  explicit NonBlocking(const sc_core::sc_module_name& name) : sc_module(name) {
    socket.register_nb_transport_bw(this, &NonBlocking::backward);
  }
  void free(tlm::tlm_generic_payload*) override {}
  tlm::tlm_sync_enum backward(tlm::tlm_generic_payload& given, tlm::tlm_phase& phase,
                              sc_core::sc_time&) {
    if (phase != tlm::BEGIN_RESP) return tlm::TLM_ACCEPTED;
    responses.push_back(given.get_response_status());
    phase = tlm::END_RESP;
    return tlm::TLM_UPDATED;
  }
  void send(tlm::tlm_command command, std::uint64_t address, bool with_enables = false) {
    payload.acquire();
    payload.set_command(command);
    payload.set_address(address);
    payload.set_data_ptr(reinterpret_cast<unsigned char*>(&word));
    payload.set_data_length(4);
    payload.set_streaming_width(4);
    payload.set_byte_enable_ptr(with_enables ? reinterpret_cast<unsigned char*>(&enables)
                                             : nullptr);
    payload.set_byte_enable_length(4);
    payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
    tlm::tlm_phase phase = tlm::BEGIN_REQ;
    sc_core::sc_time delay;
    EXPECT_EQ(socket->nb_transport_fw(payload, phase, delay), tlm::TLM_ACCEPTED);
    sc_core::sc_start(sc_core::sc_time(1, sc_core::SC_NS));
    payload.release();
  }
};

TEST(RegisterTime, AnswersNonBlockingAccesses) {
  rtl::RegisterBlock block("block", kTable);
  NonBlocking bus("bus");
  bus.socket.bind(block.bus);
  sc_core::sc_start(sc_core::SC_ZERO_TIME);
  bus.send(tlm::TLM_READ_COMMAND, 0);
  EXPECT_EQ(bus.word, 5U);
  bus.word = 9;
  bus.send(tlm::TLM_WRITE_COMMAND, 0);
  EXPECT_EQ(block.get(kControl), 9U);
  bus.word = 3;
  bus.send(tlm::TLM_WRITE_COMMAND, 0, true);
  bus.send(tlm::TLM_WRITE_COMMAND, 4);
  bus.send(tlm::TLM_READ_COMMAND, 0x0C);
  EXPECT_EQ(block.get(kControl), 9U);
  EXPECT_THAT(bus.responses, testing::ElementsAre(tlm::TLM_OK_RESPONSE, tlm::TLM_OK_RESPONSE,
                                                  tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE,
                                                  tlm::TLM_COMMAND_ERROR_RESPONSE,
                                                  tlm::TLM_ADDRESS_ERROR_RESPONSE));
}

// An initiator that ends each response late: the next request leaves as soon as the last one has
// ended, and its response waits for the end of the previous one (response exclusion).
struct Late : sc_core::sc_module, tlm::tlm_mm_interface {
  struct Access {
    tlm::tlm_generic_payload payload;
    std::uint32_t word;
  };
  tlm_utils::simple_initiator_socket<Late> socket{"socket"};
  std::vector<std::unique_ptr<Access>> accesses;
  std::vector<std::string> seen;  // phase, access, time in ns
  std::size_t sent = 0;
  tlm::tlm_generic_payload* open = nullptr;  // a response that has not ended
  sc_core::sc_event end;
  SC_HAS_PROCESS(Late);
  explicit Late(const sc_core::sc_module_name& name) : sc_module(name) {
    socket.register_nb_transport_bw(this, &Late::backward);
    SC_METHOD(end_response);
    sensitive << end;
    dont_initialize();
  }
  void free(tlm::tlm_generic_payload*) override {}
  void add(tlm::tlm_command command, std::uint64_t address, std::uint32_t word) {
    accesses.push_back(std::make_unique<Access>());
    Access& access = *accesses.back();
    access.word = word;
    access.payload.set_mm(this);
    access.payload.set_command(command);
    access.payload.set_address(address);
    access.payload.set_data_ptr(reinterpret_cast<unsigned char*>(&access.word));
    access.payload.set_data_length(4);
    access.payload.set_streaming_width(4);
  }
  std::string number(const tlm::tlm_generic_payload& payload) const {
    for (std::size_t i = 0; i < accesses.size(); ++i)
      if (&accesses[i]->payload == &payload) return std::to_string(i);
    return "?";
  }
  void note(const char* what, const tlm::tlm_generic_payload& payload) {
    seen.push_back(what + number(payload) + "@" +
                   std::to_string(sc_core::sc_time_stamp() / sc_core::sc_time(1, sc_core::SC_NS))
                       .substr(0, 2));
  }
  void send() {
    if (sent == accesses.size()) return;
    tlm::tlm_generic_payload& payload = accesses[sent++]->payload;
    payload.acquire();
    tlm::tlm_phase phase = tlm::BEGIN_REQ;
    sc_core::sc_time delay(10, sc_core::SC_NS);
    EXPECT_EQ(socket->nb_transport_fw(payload, phase, delay), tlm::TLM_ACCEPTED);
  }
  tlm::tlm_sync_enum backward(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                              sc_core::sc_time&) {
    EXPECT_TRUE(phase == tlm::BEGIN_RESP) << phase;
    EXPECT_EQ(open, nullptr) << "two responses at once";
    note("r", payload);
    open = &payload;
    end.notify(sc_core::sc_time(25, sc_core::SC_NS));
    send();
    return tlm::TLM_ACCEPTED;
  }
  void end_response() {
    tlm::tlm_generic_payload& payload = *std::exchange(open, nullptr);
    note("e", payload);
    tlm::tlm_phase phase = tlm::END_RESP;
    sc_core::sc_time delay;
    socket->nb_transport_fw(payload, phase, delay);
    payload.release();
  }
};

TEST(RegisterTime, ResponseWaitsForEndOfPreviousOne) {
  rtl::RegisterBlock block("block", kTable);
  Late late("late");
  late.socket.bind(block.bus);
  sc_core::sc_start(sc_core::SC_ZERO_TIME);
  late.add(tlm::TLM_WRITE_COMMAND, 0, 11);
  late.add(tlm::TLM_READ_COMMAND, 0, 0);
  late.add(tlm::TLM_READ_COMMAND, 0x0C, 0);
  late.send();
  sc_core::sc_start(sc_core::sc_time(200, sc_core::SC_NS));
  EXPECT_THAT(late.seen,
              testing::ElementsAre("r0@10", "e0@35", "r1@35", "e1@60", "r2@60", "e2@85"));
  EXPECT_EQ(block.get(kControl), 11U);
  EXPECT_EQ(late.accesses[1]->word, 11U);
  EXPECT_EQ(late.accesses[1]->payload.get_response_status(), tlm::TLM_OK_RESPONSE);
  EXPECT_EQ(late.accesses[2]->payload.get_response_status(), tlm::TLM_ADDRESS_ERROR_RESPONSE);
  for (const auto& access : late.accesses) EXPECT_EQ(access->payload.get_ref_count(), 0);
}

TEST_F(Registers, ProvideNamesAndTexts) {
  EXPECT_EQ(bus.block.index_of("CONTROL"), std::size_t{kControl});
  EXPECT_EQ(bus.block.index_of("FLAGS"), std::size_t{kFlags});
  EXPECT_EQ(bus.block.index_of("COUNT"), std::size_t{kCount});
  EXPECT_THROW(bus.block.index_of("FLAG"), spec::ConfigError);
  EXPECT_THAT(
      rtl::register_table_markdown(kTable),
      testing::HasSubstr("| 0x010 | `FLAGS` | W1C | 0x00000000 | bit i: error i was seen |"));
}

// Values by hand: three fields, one of them a choice, and two registers that share their fields.
namespace fields {
constexpr std::string_view kCodes[] = {"off", "own-way"};
constexpr spec::Field kMode{"a.mode", 1, 0, Access::kReadWrite, "off where it is not built",
                            kCodes,   1},
    kCount{"count", 12, 8, Access::kReadOnly, "U5"},
    kTop{"top", 31, 31, Access::kReadWrite, {}, kCodes};
constexpr spec::Field kAll[] = {kMode, kCount, kTop};
constexpr spec::Field kLow[] = {{"address", 31, 6, Access::kReadWrite, "a multiple of 64"}};
constexpr std::array kId = spec::number(Access::kConstant, 0xDEB0);
constexpr spec::RegisterInfo kTable[] = {{0x00, "ID", "which one", kId},
                                         {0x10, "RULES", "rules", kAll},
                                         {0x14, "FROM", "source", kLow},
                                         {0x18, "TO", "target", kLow}};
}  // namespace fields

TEST(RegisterFields, ExtractAndInsertAtTheirPosition) {
  EXPECT_EQ(fields::kMode.mask(), 0x3u);
  EXPECT_EQ(fields::kCount.mask(), 0x1F00u);
  EXPECT_EQ(fields::kTop.mask(), 0x80000000u);
  EXPECT_EQ(fields::kLow[0].mask(), 0xFFFFFFC0u);
  EXPECT_EQ((spec::Field{"all", 31, 0, Access::kReadWrite, {}}.mask()), 0xFFFFFFFFu);
  EXPECT_EQ(fields::kCount.of(0xFFFF15FF), 0x15u);
  EXPECT_EQ(fields::kTop.of(0x7FFFFFFF), 0u);
  EXPECT_EQ(fields::kCount.in(0x15), 0x1500u);
  EXPECT_EQ(fields::kCount.in(0xFFFFFFFF), 0x1F00u) << "bits that do not fit are dropped";
  EXPECT_EQ(fields::kTable[0].mask(), 0xFFFFFFFFu) << "one number";
  EXPECT_EQ(fields::kTable[1].mask(), 0x80001F03u);
}

TEST(RegisterFields, RejectUnorderedOrOverlappingFields) {
  EXPECT_TRUE(spec::fields_are_in_order(fields::kTable));
  const auto ordered = [](std::initializer_list<spec::Field> list) {
    const std::vector<spec::Field> all(list);
    const spec::RegisterInfo info[] = {{0, "A", "a", all}};
    return spec::fields_are_in_order(info);
  };
  constexpr Access kRw = Access::kReadWrite;
  EXPECT_TRUE(ordered({{"a", 3, 0, kRw, {}}, {"b", 4, 4, kRw, {}}}));
  EXPECT_FALSE(ordered({{"a", 3, 0, kRw, {}}, {"b", 4, 3, kRw, {}}}));
  EXPECT_FALSE(ordered({{"b", 4, 4, kRw, {}}, {"a", 3, 0, kRw, {}}}));
  EXPECT_FALSE(ordered({{"a", 0, 3, kRw, {}}}));
  EXPECT_FALSE(ordered({{"a", 32, 32, kRw, {}}}));
  EXPECT_FALSE(ordered({})) << "a register without a field";
  EXPECT_TRUE(ordered({{"a", 1, 0, kRw, {}, {}, 3}}));
  EXPECT_FALSE(ordered({{"a", 1, 0, kRw, {}, {}, 4}})) << "its reset value does not fit";
  EXPECT_TRUE(ordered({{"a", 1, 1, Access::kCommand, {}}}));
  EXPECT_FALSE(ordered({{"a", 1, 0, Access::kCommand, {}}})) << "a command of two bits";
  EXPECT_FALSE(ordered({{"a", 1, 1, Access::kCommand, {}, {}, 1}})) << "that does not read as 0";
}

TEST(RegisterFields, FillTheirOwnTable) {
  const std::string page = rtl::register_table_markdown(fields::kTable);
  for (const char* const row :
       {"| 0x010 | `RULES` | RW, RO | 0x00000001 | rules |\n",
        "| `RULES` | [1:0] | `a.mode` | RW | 1 | 0 off, 1 own-way; off where it is not built |\n",
        "| `RULES` | [12:8] | `count` | RO | 0 | U5 |\n",
        "| `RULES` | [31] | `top` | RW | 0 | 0 off, 1 own-way |\n",
        "| `FROM`, `TO` | [31:6] | `address` | RW | 0 | a multiple of 64 |\n"})
    EXPECT_THAT(page, testing::HasSubstr(row));
  // Where parameters load TO, its fields differ from those of FROM; there are none without a reset.
  constexpr spec::LoadedRegister kLoaded[] = {{0x18, 0x80}};
  const std::string loaded = rtl::register_table_markdown(fields::kTable, kLoaded);
  for (const char* const row : {"| 0x018 | `TO` | RW | 0x00000080 | target |\n",
                                "| `FROM` | [31:6] | `address` | RW | 0 | a multiple of 64 |\n",
                                "| `TO` | [31:6] | `address` | RW | 2 | a multiple of 64 |\n"})
    EXPECT_THAT(loaded, testing::HasSubstr(row));
  static constexpr std::array kKept = spec::number(Access::kShared, std::nullopt);
  constexpr spec::RegisterInfo kWord[] = {{0, "WORD", "of a memory", kKept}};
  EXPECT_THAT(rtl::register_table_markdown(kWord),
              testing::HasSubstr("| 0x000 | `WORD` | RWH | none | of a memory |\n"));
  EXPECT_THAT(rtl::register_table_markdown(kTable), testing::Not(testing::HasSubstr("| field |")));
}

TEST(RegisterFields, BecomeMacrosOfC) {
  EXPECT_EQ(rtl::register_c_macros(std::span(fields::kTable).first(2), "DEBURR_X"),
            "\n/* RO: which one */\n"
            "#define DEBURR_X_ID 0x000u\n"
            "#define DEBURR_X_ID_RESET 0x0000DEB0u\n"
            "\n/* RW, RO: rules */\n"
            "#define DEBURR_X_RULES 0x010u\n"
            "#define DEBURR_X_RULES_RESET 0x00000001u\n"
            "#define DEBURR_X_RULES_A_MODE_MASK 0x00000003u /* RW: off where it is not built */\n"
            "#define DEBURR_X_RULES_A_MODE_SHIFT 0u\n"
            "#define DEBURR_X_RULES_A_MODE_OFF 0u\n"
            "#define DEBURR_X_RULES_A_MODE_OWN_WAY 1u\n"
            "#define DEBURR_X_RULES_COUNT_MASK 0x00001F00u /* RO: U5 */\n"
            "#define DEBURR_X_RULES_COUNT_SHIFT 8u\n"
            "#define DEBURR_X_RULES_TOP_MASK 0x80000000u /* RW */\n"
            "#define DEBURR_X_RULES_TOP_SHIFT 31u\n"
            "#define DEBURR_X_RULES_TOP_OFF 0u\n"
            "#define DEBURR_X_RULES_TOP_OWN_WAY 1u\n");
  constexpr spec::LoadedRegister kLoaded[] = {{0x18, 0x80}};
  EXPECT_EQ(rtl::register_c_macros(std::span(fields::kTable).last(1), "X", kLoaded),
            "\n/* RW: target */\n#define X_TO 0x018u\n"
            "#define X_TO_RESET 0x00000080u /* with default parameters */\n"
            "#define X_TO_ADDRESS_MASK 0xFFFFFFC0u /* a multiple of 64 */\n"
            "#define X_TO_ADDRESS_SHIFT 6u\n");
}

// A table may be in any order.
TEST(RegisterTable, FindsRegistersInAnyOrder) {
  static constexpr std::array one = spec::number(Access::kReadWrite, 1),
                              two = spec::number(Access::kReadWrite, 2),
                              three = spec::number(Access::kReadWrite, 3),
                              four = spec::number(Access::kReadWrite, 4);
  static constexpr spec::RegisterInfo table[] = {{300, "LAST", "a", one},
                                                 {240, "MIDDLE", "b", two},
                                                 {0, "FIRST", "c", three},
                                                 {304, "BEHIND", "d", four}};
  rtl::RegisterBlock block("block", table);
  platform::RegisterHost host("host");
  host.bus.bind(block.bus);
  sc_core::sc_start(sc_core::SC_ZERO_TIME);
  for (const spec::RegisterInfo& r : table) EXPECT_EQ(host.read(r.offset), r.reset()) << r.name;
  for (const std::uint32_t hole : {4u, 236u, 244u, 296u, 308u})
    EXPECT_EQ(host.try_write(hole, 0), tlm::TLM_ADDRESS_ERROR_RESPONSE) << hole;
}

TEST(RegisterTable, MistakesAreRejected) {
  static constexpr spec::RegisterInfo twice[] = {{0, "A", "a", spec::kNumber},
                                                 {0, "B", "b", spec::kNumber}};
  static constexpr spec::RegisterInfo odd[] = {{2, "A", "a", spec::kNumber}};
  EXPECT_THROW(rtl::RegisterBlock("twice", twice), spec::CheckFailed);
  EXPECT_THROW(rtl::RegisterBlock("odd", odd), spec::CheckFailed);
  static constexpr spec::RegisterInfo bare[] = {{0, "A", "a", {}}};
  EXPECT_THROW(rtl::RegisterBlock("bare", bare), spec::CheckFailed);
}

}  // namespace
}  // namespace deburr::tb::registers_test
