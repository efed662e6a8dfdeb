// SPDX-License-Identifier: MIT
// Gates and nanoseconds of operators, registers, memories and links by width: the fits of
// osu018.json, made by `scripts/synthesise --primitives`, and the area of SRAM of sram.json.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "rtl_model/fabric/operators.h"

namespace deburr::tool {

// A sum of products of 1, a, b, log2(a), log2(b) and min(a,b): "a*b + a*b*min(a,b)".
class Fit {
 public:
  Fit() = default;
  // Throws FileError for a form that is not such a sum, or has another number of coefficients.
  Fit(std::string_view form, std::vector<double> coefficients);
  // At least 0. a and b count as at least 1.
  double at(double a, double b) const;

 private:
  struct Term {
    double coefficient;
    std::vector<std::string> factors;
  };
  std::vector<Term> terms_;
};

// The text of osu018.json or sram.json without the measured rows, which only made the fits.
std::string without_rows(std::string_view text);

class Primitives {
 public:
  // From the text of osu018.json. Throws FileError if a kind is missing.
  explicit Primitives(std::string_view json);
  // Of the file in the program.
  static const Primitives& embedded();

  const std::string& technology() const { return technology_; }
  double multiply_ns() const { return ns("multiply", 24, 24); }  // the yardstick
  // Gates are those of NAND2X1. Kinds: name_of(OperatorKind), register, register_enable, memory,
  // memory_write, memory_read, link, fifo.
  double gates(std::string_view kind, double a, double b = 0) const {
    return of(kind).gates.at(a, b);
  }
  double ns(std::string_view kind, double a, double b = 0) const { return of(kind).ns.at(a, b); }
  double gates(const rtl::Operator& one) const;  // all of its count
  double ns(const rtl::Operator& one) const;     // all of its count in series

 private:
  struct Kind {
    Fit gates, ns;
  };
  const Kind& of(std::string_view kind) const;

  std::string technology_;
  std::map<std::string, Kind, std::less<>> kinds_;
};

}  // namespace deburr::tool
