// SPDX-License-Identifier: MIT
// A condition that every point of a sweep must meet: `texture.cache.bytes >= 64 *
// texture.cache.ways`.
//
//   or       := and ("or" and)*            sum     := product (("+" | "-") product)*
//   and      := not ("and" not)*           product := unary (("*" | "/" | "%") unary)*
//   not      := "not" not | compare        unary   := "-" unary | value
//   compare  := sum (("==" | "!=" | "<" | "<=" | ">" | ">=") sum)?
//   value    := number | parameter | word | "(" or ")"
//
// A word is a value of the choice that it is compared with. Numbers are doubles.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <variant>

#include "tb/results/parameter_set.h"

namespace deburr::tb {

class Constraint {
 public:
  using Value = std::variant<double, bool, std::string>;
  using Term = std::function<Value(const ParameterSet&)>;

  // ConfigError that begins with `where` for what is no condition over the parameters of `known`.
  Constraint(std::string text, std::string where, const ParameterSet& known);
  bool holds(const ParameterSet& set) const;
  const std::string& text() const { return text_; }

 private:
  std::string text_, where_;
  Term condition_;
};

}  // namespace deburr::tb
