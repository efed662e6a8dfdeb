// SPDX-License-Identifier: MIT
// An expression of a sweep's file: a condition on parameters (`texture.cache.bytes >= 64 *
// texture.cache.ways`), a metric made of keys of result.json (`work.bilinears / cycles`), or a
// limit on metrics (`hit_rate >= 0.97`).
//
//   or       := and ("or" and)*            sum     := product (("+" | "-") product)*
//   and      := not ("and" not)*           product := unary (("*" | "/" | "%") unary)*
//   not      := "not" not | compare        unary   := "-" unary | value
//   compare  := sum (("==" | "!=" | "<" | "<=" | ">" | ">=") sum)?
//   value    := number | name | word | "(" or ")"
//
// A word is one of the values of the choice with which it is compared. Numbers are doubles, written
// in decimal or hexadecimal (0x100).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "spec/error.h"
#include "tb/run/parameter_set.h"

namespace deburr::tool {

class DivisionByZero : public spec::ConfigError {
 public:
  using ConfigError::ConfigError;
};

// The names that an expression may use, and the terms for its error messages.
struct ExpressionNames {
  std::string expression;  // "constraint"
  std::string name;        // "a parameter"
  // The range of a name, as in Parameter::range; nullopt: unknown name.
  std::function<std::optional<std::string>(const std::string&)> range;
  std::function<std::vector<std::string>(const std::string&)> near_matches;
};

class Expression {
 public:
  using Value = std::variant<double, bool, std::string>;
  using Lookup = std::function<Value(const std::string& name)>;
  using Term = std::function<Value(const Lookup&)>;

  // Throws ConfigError that begins with `where` for an invalid expression over the names.
  Expression(std::string text, std::string where, const ExpressionNames& names);

  // Throws DivisionByZero; ConfigError if the result is not a number.
  double number(const Lookup& lookup) const;
  bool reference(const Lookup& lookup) const;
  // The amount by which a comparison with < <= > >= fails to hold, relative to the absolute value
  // of its right side; 0: it holds. Infinite if a side is undefined.
  double violation(const Lookup& lookup) const;
  // Whether violation() applies.
  bool is_comparison() const { return violation_ != nullptr; }

  const std::string& text() const { return origin_->text; }
  const std::string& where() const { return origin_->where; }
  // In the order of first use.
  const std::vector<std::string>& names() const { return names_; }

 private:
  // For errors, including those of terms.
  struct Origin {
    std::string text, where, kind;
    std::string message(const std::string& what) const;
    [[noreturn]] void fail(const std::string& what) const;
    template <class T>
    T as(const Value& value, std::string_view wanted) const;
  };
  class Parser;

  std::shared_ptr<const Origin> origin_;
  Term term_;
  std::function<double(const Lookup&)> violation_;
  std::vector<std::string> names_;
};

// A condition that every point of a sweep must meet.
class Constraint {
 public:
  // Throws ConfigError that begins with `where` for an invalid condition over the parameters of
  // `known`.
  Constraint(std::string text, std::string where, const tb::ParameterSet& known);
  bool holds(const tb::ParameterSet& set) const;
  const std::string& text() const { return condition_.text(); }

 private:
  Expression condition_;
};

}  // namespace deburr::tool
