// SPDX-License-Identifier: MIT
#include "tool/cost/primitives.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "spec/error.h"
#include "tool/cost/embedded_cost.h"

namespace deburr::tool {
namespace {

constexpr std::string_view kFile = "tool/cost/osu018.json";
constexpr auto kOthers = std::to_array<std::string_view>(
    {"register", "register_enable", "memory", "memory_write", "memory_read", "link", "fifo"});

std::vector<std::string> split(std::string_view text, std::string_view at) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(at, begin), text.size());
    parts.emplace_back(text.substr(begin, end - begin));
    begin = end + at.size();
  }
  return parts;
}

double factor(std::string_view name, double a, double b) {
  if (name == "1") return 1;
  if (name == "a") return a;
  if (name == "b") return b;
  if (name == "log2(a)") return std::log2(a);
  if (name == "log2(b)") return std::log2(b);
  if (name == "min(a,b)") return std::min(a, b);
  throw spec::FileError(fmt::format("{}: unknown factor '{}' of a fit", kFile, name));
}

}  // namespace

Fit::Fit(std::string_view form, std::vector<double> coefficients) {
  const std::vector<std::string> sum = split(form, " + ");
  if (sum.size() != coefficients.size())
    throw spec::FileError(fmt::format("{}: '{}' has {} terms and {} coefficients", kFile, form,
                                      sum.size(), coefficients.size()));
  for (std::size_t i = 0; i < sum.size(); ++i) {
    terms_.push_back({coefficients[i], split(sum[i], "*")});
    for (const std::string& name : terms_.back().factors) factor(name, 1, 1);
  }
}

double Fit::at(double a, double b) const {
  a = std::max(a, 1.0);
  b = std::max(b, 1.0);
  double sum = 0;
  for (const Term& term : terms_) {
    double product = term.coefficient;
    for (const std::string& name : term.factors) product *= factor(name, a, b);
    sum += product;
  }
  return std::max(sum, 0.0);
}

std::string without_rows(std::string_view text) {
  constexpr std::string_view kBegin = "\"rows\": [[", kEnd = "]]";
  std::string kept;
  for (std::size_t begin; (begin = text.find(kBegin)) != std::string_view::npos;) {
    kept += text.substr(0, text.rfind(',', begin));
    text.remove_prefix(std::min(text.find(kEnd, begin) + kEnd.size(), text.size()));
  }
  return kept += text;
}

Primitives::Primitives(std::string_view text) {
  try {
    const nlohmann::json json = nlohmann::json::parse(without_rows(text));
    technology_ = json.at("technology").get<std::string>();
    for (const auto& entry : json.at("kinds").items()) {
      const nlohmann::json& kind = entry.value();
      const auto fit = [&](const char* of) {
        const nlohmann::json& one = kind.at(of);
        return Fit(one.at("form").get<std::string>(),
                   one.at("coefficients").get<std::vector<double>>());
      };
      kinds_[entry.key()] = {fit("gates"), fit("ns")};
    }
  } catch (const nlohmann::json::exception& error) {
    throw spec::FileError(fmt::format("{}: {}", kFile, error.what()));
  }
  for (auto kind = rtl::OperatorKind::kAdd; kind <= rtl::OperatorKind::kLogic;
       kind = static_cast<rtl::OperatorKind>(static_cast<int>(kind) + 1))
    of(name_of(kind));
  for (const std::string_view kind : kOthers) of(kind);
}

const Primitives& Primitives::embedded() {
  static const Primitives primitives(embedded::osu018_json());
  return primitives;
}

const Primitives::Kind& Primitives::of(std::string_view kind) const {
  const auto found = kinds_.find(kind);
  if (found == kinds_.end())
    throw spec::FileError(
        fmt::format("{}: no kind '{}': run scripts/synthesise --primitives", kFile, kind));
  return found->second;
}

double Primitives::gates(const rtl::Operator& one) const {
  return one.count * gates(name_of(one.kind), one.a, one.b);
}

double Primitives::ns(const rtl::Operator& one) const {
  return one.count * ns(name_of(one.kind), one.a, one.b);
}

}  // namespace deburr::tool
