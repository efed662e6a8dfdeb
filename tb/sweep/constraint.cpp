// SPDX-License-Identifier: MIT
#include "tb/sweep/constraint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tb/base/near_matches.h"

namespace deburr::tb {
namespace {

using Value = Constraint::Value;
using Term = Constraint::Term;
using spec::ConfigError;

Value value_of(const std::string& text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size()) return number;
  if (text == "true" || text == "false") return text == "true";
  return text;
}

std::string_view kind_of(const Value& value) {
  constexpr std::string_view kKinds[] = {"a number", "true or false", "a word"};
  return kKinds[value.index()];
}

// What a part of the text is, as far as errors and comparisons need it.
struct Operand {
  Term term;
  const Parameter* parameter = nullptr;  // it is this one and nothing else
  std::string word{};                    // it is no parameter and no number
};

class Parser {
 public:
  Parser(const std::string& text, const std::string& where, const ParameterSet& known)
      : text_(text), where_(where), known_(known) {}

  Term parse() {
    next();
    Operand all = disjunction();
    if (!token_.empty()) fail(fmt::format("'{}' was not expected", token_));
    return settled(all);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw ConfigError(fmt::format("{}: constraint '{}': {}", where_, text_, what));
  }

  static bool in_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.';
  }

  void next() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    const std::size_t begin = at_;
    if (at_ == text_.size()) {
      token_.clear();
      return;
    }
    if (in_name(text_[at_])) {
      while (at_ < text_.size() && in_name(text_[at_])) ++at_;
    } else {
      const char c = text_[at_++];
      if (at_ < text_.size() && text_[at_] == '=' &&
          std::string_view("=!<>").find(c) != std::string_view::npos)
        ++at_;
    }
    token_ = text_.substr(begin, at_ - begin);
  }

  bool take(std::string_view token) {
    if (token_ != token) return false;
    next();
    return true;
  }

  // A word by itself has no value.
  Term settled(const Operand& operand) const {
    if (operand.word.empty()) return operand.term;
    fail(fmt::format("'{}' is neither a parameter nor a number{}", operand.word,
                     did_you_mean(known_.near_matches(operand.word))));
  }

  template <class T>
  T as(const Value& value, std::string_view wanted) const {
    if (const T* held = std::get_if<T>(&value)) return *held;
    fail(fmt::format("expected {}, got {}", wanted, kind_of(value)));
  }
  std::function<double(const ParameterSet&)> number(const Operand& operand) const {
    return [*this, term = settled(operand)](const ParameterSet& set) {
      return as<double>(term(set), "a number");
    };
  }
  std::function<bool(const ParameterSet&)> truth(const Operand& operand) const {
    return [*this, term = settled(operand)](const ParameterSet& set) {
      return as<bool>(term(set), "true or false");
    };
  }

  Operand disjunction() {
    Operand left = conjunction();
    while (take("or"))
      left = {[a = truth(left), b = truth(conjunction())](const ParameterSet& s) -> Value {
        return a(s) || b(s);
      }};
    return left;
  }

  Operand conjunction() {
    Operand left = negation();
    while (take("and"))
      left = {[a = truth(left), b = truth(negation())](const ParameterSet& s) -> Value {
        return a(s) && b(s);
      }};
    return left;
  }

  Operand negation() {
    if (!take("not")) return comparison();
    return {[a = truth(negation())](const ParameterSet& s) -> Value { return !a(s); }};
  }

  // The choice that a word belongs to must have it.
  Term compared(const Operand& operand, const Operand& with) const {
    if (operand.word.empty() || !with.parameter) return settled(operand);
    std::vector<std::string> choices;
    const std::string& range = with.parameter->range;
    for (std::size_t from = 0; from <= range.size();) {
      const std::size_t bar = std::min(range.find(" | ", from), range.size());
      choices.push_back(range.substr(from, bar - from));
      from = bar + 3;
    }
    const bool free_text = range.find("file") != std::string::npos || range == "name";
    if (!free_text && std::find(choices.begin(), choices.end(), operand.word) == choices.end())
      fail(fmt::format("'{}' is no value of {}: it wants {}{}", operand.word, with.parameter->name,
                       range, did_you_mean(near_matches(operand.word, choices))));
    return [word = operand.word](const ParameterSet&) -> Value { return word; };
  }

  Operand comparison() {
    Operand left = sum();
    const std::string op = token_;
    if (op != "==" && op != "!=" && op != "<" && op != "<=" && op != ">" && op != ">=") return left;
    next();
    const Operand right = sum();
    if (op == "==" || op == "!=")
      return {[*this, a = compared(left, right), b = compared(right, left),
               equal = op == "=="](const ParameterSet& s) -> Value {
        const Value x = a(s), y = b(s);
        if (x.index() != y.index())
          fail(fmt::format("{} is compared with {}", kind_of(x), kind_of(y)));
        return (x == y) == equal;
      }};
    return {[a = number(left), b = number(right), op](const ParameterSet& s) -> Value {
      const double x = a(s), y = b(s);
      if (op == "<") return x < y;
      if (op == "<=") return x <= y;
      return op == ">" ? x > y : x >= y;
    }};
  }

  Operand sum() {
    Operand left = product();
    while (token_ == "+" || token_ == "-") {
      const double sign = token_ == "+" ? 1 : -1;
      next();
      left = {[a = number(left), b = number(product()), sign](const ParameterSet& s) -> Value {
        return a(s) + sign * b(s);
      }};
    }
    return left;
  }

  Operand product() {
    Operand left = unary();
    while (token_ == "*" || token_ == "/" || token_ == "%") {
      const char op = token_[0];
      next();
      left = {[*this, a = number(left), b = number(unary()), op](const ParameterSet& s) -> Value {
        const double x = a(s), y = b(s);
        if (op == '*') return x * y;
        if (y == 0) fail("division by zero");
        return op == '/' ? x / y : std::fmod(x, y);
      }};
    }
    return left;
  }

  Operand unary() {
    if (!take("-")) return value();
    return {[a = number(unary())](const ParameterSet& s) -> Value { return -a(s); }};
  }

  Operand value() {
    if (token_.empty()) fail("it ends too early");
    if (take("(")) {
      Operand inner = disjunction();
      if (!take(")")) fail("a ')' is missing");
      return inner;
    }
    if (!in_name(token_[0])) fail(fmt::format("'{}' was not expected", token_));
    const std::string token = std::exchange(token_, "");
    next();
    if (const Parameter* parameter = known_.find(token))
      return {[name = token](const ParameterSet& s) { return value_of(s.find(name)->text()); },
              parameter};
    Value constant = value_of(token);
    if (!std::holds_alternative<std::string>(constant))
      return {[constant](const ParameterSet&) -> Value { return constant; }};
    return {nullptr, nullptr, token};
  }

  std::string text_, where_;
  const ParameterSet& known_;
  std::size_t at_ = 0;
  std::string token_;
};

}  // namespace

Constraint::Constraint(std::string text, std::string where, const ParameterSet& known)
    : text_(std::move(text)),
      where_(std::move(where)),
      condition_(Parser(text_, where_, known).parse()) {
  holds(known);  // what cannot be computed shows on the defaults already
}

bool Constraint::holds(const ParameterSet& set) const {
  const Value value = condition_(set);
  if (const bool* truth = std::get_if<bool>(&value)) return *truth;
  throw ConfigError(fmt::format("{}: constraint '{}': it is {}, not true or false", where_, text_,
                                kind_of(value)));
}

}  // namespace deburr::tb
