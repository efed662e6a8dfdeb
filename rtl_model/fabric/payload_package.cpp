// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <map>
#include <utility>

#include "rtl_model/fabric/payload.h"

namespace deburr::rtl {
namespace {

// Keywords of IEEE 1800-2017, annex B.
constexpr std::string_view kReserved =
    " accept_on alias always always_comb always_ff always_latch and assert assign assume automatic "
    "before begin bind bins binsof bit break buf bufif0 bufif1 byte case casex casez cell chandle "
    "checker class clocking cmos config const constraint context continue cover covergroup "
    "coverpoint cross deassign default defparam design disable dist do edge else end endcase "
    "endchecker endclass endclocking endconfig endfunction endgenerate endgroup endinterface "
    "endmodule endpackage endprimitive endprogram endproperty endsequence endspecify endtable "
    "endtask enum event eventually expect export extends extern final first_match for force "
    "foreach forever fork forkjoin function generate genvar global highz0 highz1 if iff ifnone "
    "ignore_bins illegal_bins implements implies import incdir include initial inout input inside "
    "instance int integer interconnect interface intersect join join_any join_none large let "
    "liblist library local localparam logic longint macromodule matches medium modport module nand "
    "negedge nettype new nexttime nmos nor noshowcancelled not notif0 notif1 null or output "
    "package packed parameter pmos posedge primitive priority program property protected pull0 "
    "pull1 pulldown pullup pulsestyle_ondetect pulsestyle_onevent pure rand randc randcase "
    "randsequence rcmos real realtime ref reg reject_on release repeat restrict return rnmos rpmos "
    "rtran rtranif0 rtranif1 s_always s_eventually s_nexttime s_until s_until_with scalared "
    "sequence shortint shortreal showcancelled signed small soft solve specify specparam static "
    "string strong strong0 strong1 struct super supply0 supply1 sync_accept_on sync_reject_on "
    "table tagged task this throughout time timeprecision timeunit tran tranif0 tranif1 tri tri0 "
    "tri1 triand trior trireg type typedef union unique unique0 unsigned until until_with untyped "
    "use uwire var vectored virtual void wait wait_order wand weak weak0 weak1 while wildcard wire "
    "with within wor xnor xor ";

std::string legal(const std::string& name) {
  return kReserved.find(" " + name + " ") == std::string_view::npos ? name : name + "_";
}

// Typedefs by name; if two types share a name but not their fields, the later one gets a number.
class PackageWriter {
 public:
  std::string declare(const PayloadNode& node) {
    if (node.kind == PayloadNode::Kind::kField) return declare_integer(node);
    std::string body;
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
      body += member(*child);
    const auto& [name, inserted] = unique(node.type, body);
    if (inserted)
      text += fmt::format("  // {} bits\n  typedef struct packed {{\n{}  }} {};\n\n", width(node),
                          body, name);
    return name;
  }
  std::string text;

 private:
  std::string declare_integer(const PayloadNode& node) {
    const auto& [name, inserted] = unique(
        fmt::format("{}{}_t", node.field.is_signed ? 's' : 'u', node.field.bits), type_of(node));
    if (inserted)
      text +=
          fmt::format("  // {} bits\n  typedef {} {};\n\n", node.field.bits, type_of(node), name);
    return name;
  }
  static std::uint32_t width(const PayloadNode& node) {
    if (node.kind == PayloadNode::Kind::kField) return node.field.bits;
    std::uint32_t sum = 0;
    for (const PayloadNode& child : node.children) sum += width(child);
    return sum;
  }
  std::pair<std::string, bool> unique(const std::string& wanted, const std::string& body) {
    for (int number = 1;; ++number) {
      const std::string name =
          number == 1 ? wanted
                      : fmt::format("{}_{}_t", wanted.substr(0, wanted.size() - 2), number);
      const auto [at, inserted] = bodies_.try_emplace(name, body);
      if (inserted || at->second == body) return {name, inserted};
    }
  }
  static const Field& first_field(const PayloadNode& node) {
    return node.kind == PayloadNode::Kind::kField ? node.field : first_field(node.children.front());
  }
  // The type without the declared name.
  std::string type_of(const PayloadNode& node) {
    std::string dimensions;
    const PayloadNode* at = &node;
    for (; at->kind == PayloadNode::Kind::kArray; at = &at->children.front())
      dimensions += fmt::format("[{}:0]", at->children.size() - 1);
    if (at->kind == PayloadNode::Kind::kStruct) {
      const std::string type = declare(*at);
      return dimensions.empty() ? type : type + " " + dimensions;
    }
    std::string type = at->field.is_signed && dimensions.empty() ? "logic signed" : "logic";
    if (at->field.bits > 1) dimensions += fmt::format("[{}:0]", at->field.bits - 1);
    return dimensions.empty() ? type : type + " " + dimensions;
  }
  std::string member(const PayloadNode& node) {
    const std::string type = type_of(node);
    std::string note;
    const PayloadNode* at = &node;
    while (at->kind == PayloadNode::Kind::kArray) at = &at->children.front();
    if (at->kind == PayloadNode::Kind::kField && !at->field.format.empty())
      note = "  // " + at->field.format;
    return fmt::format("    {} {};{}\n", type, legal(node.name), note);
  }

  std::map<std::string, std::string> bodies_;
};

}  // namespace

std::string payload_package(const std::string& name, std::span<const Payload* const> payloads) {
  PackageWriter writer;
  for (const Payload* payload : payloads) writer.declare(payload->node());
  return fmt::format("// SPDX-License-Identifier: MIT\npackage {};\n\n{}endpackage\n", name,
                     writer.text);
}

}  // namespace deburr::rtl
