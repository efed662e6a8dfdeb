// SPDX-License-Identifier: MIT
#include "tool/sweep/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "spec/error.h"
#include "tb/base/near_matches.h"

namespace deburr::tool {
namespace {

using Value = Expression::Value;
using Term = Expression::Term;
using Lookup = Expression::Lookup;

Value value_of(const std::string& text) {
  const bool hexadecimal = text.starts_with("0x") || text.starts_with("0X");
  const char* const from = text.data() + (hexadecimal ? 2 : 0);
  const char* const to = text.data() + text.size();
  double number = 0;
  const auto [end, error] = std::from_chars(
      from, to, number, hexadecimal ? std::chars_format::hex : std::chars_format::general);
  if (error == std::errc() && end == to) return number;
  if (text == "true" || text == "false") return text == "true";
  return text;
}

std::string_view kind_of(const Value& value) {
  constexpr std::string_view kKinds[] = {"a number", "true or false", "a word"};
  return kKinds[value.index()];
}

// A parsed part of the text, as needed for errors and comparisons.
struct Operand {
  Term term;
  std::string name{}, range{};  // if it is a single name: the name and its range
  std::string word{};           // neither a name nor a number
};

// Limits hand-written expressions; generated ones are lists of conditions.
constexpr std::size_t kMostCharacters = 4000;
constexpr int kMostInside = 100;

bool is_order(std::string_view op) { return op == "<" || op == "<=" || op == ">" || op == ">="; }

}  // namespace

std::string Expression::Origin::message(const std::string& what) const {
  return fmt::format("{}: {} '{}': {}", where, kind, text, what);
}

void Expression::Origin::fail(const std::string& what) const {
  throw spec::ConfigError(message(what));
}

template <class T>
T Expression::Origin::as(const Value& value, std::string_view wanted) const {
  if (const T* held = std::get_if<T>(&value)) return *held;
  fail(fmt::format("expected {}, got {}", wanted, kind_of(value)));
}

class Expression::Parser {
 public:
  Parser(std::shared_ptr<const Origin> origin, const ExpressionNames& names)
      : origin_(std::move(origin)), text_(origin_->text), known_(names) {}

  void parse(Expression& made) {
    if (text_.size() > kMostCharacters)
      throw spec::ConfigError(fmt::format("{}: a {} of {} characters, at most {} are allowed",
                                          origin_->where, origin_->kind, text_.size(),
                                          kMostCharacters));
    next();
    const Operand all = disjunction();
    if (!token_.empty()) fail(fmt::format("unexpected '{}'", token_));
    made.term_ = settled(all);
    if (is_comparison_) made.violation_ = std::move(violation_);
    made.names_ = std::move(names_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { origin_->fail(what); }

  static bool in_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.';
  }
  // The sign in 1e-3.
  bool in_exponent(std::size_t begin) const {
    return std::isdigit(static_cast<unsigned char>(text_[begin])) &&
           !text_.substr(begin).starts_with("0x") &&
           std::string_view("eE").find(text_[at_ - 1]) != std::string_view::npos &&
           std::string_view("+-").find(text_[at_]) != std::string_view::npos;
  }

  void next() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    const std::size_t begin = at_;
    if (at_ == text_.size()) {
      token_.clear();
      return;
    }
    if (in_name(text_[at_])) {
      while (at_ < text_.size() && (in_name(text_[at_]) || in_exponent(begin))) ++at_;
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

  // A bare word is undefined.
  Term settled(const Operand& operand) const {
    if (operand.word.empty()) return operand.term;
    fail(fmt::format("'{}' is neither {} nor a number{}", operand.word, known_.name,
                     tb::did_you_mean(known_.near_matches(operand.word))));
  }
  std::function<double(const Lookup&)> number(const Operand& operand) const {
    return [origin = origin_, term = settled(operand)](const Lookup& lookup) {
      return origin->as<double>(term(lookup), "a number");
    };
  }
  std::function<bool(const Lookup&)> reference(const Operand& operand) const {
    return [origin = origin_, term = settled(operand)](const Lookup& lookup) {
      return origin->as<bool>(term(lookup), "true or false");
    };
  }

  Operand disjunction() {
    Operand left = conjunction();
    while (take("or")) {
      left = {[a = reference(left), b = reference(conjunction())](const Lookup& l) -> Value {
        return a(l) || b(l);
      }};
      is_comparison_ = false;
    }
    return left;
  }

  Operand conjunction() {
    Operand left = negation();
    while (take("and")) {
      left = {[a = reference(left), b = reference(negation())](const Lookup& l) -> Value {
        return a(l) && b(l);
      }};
      is_comparison_ = false;
    }
    return left;
  }

  // Nesting of expressions: limited, since it uses the stack.
  struct Inside {
    explicit Inside(Parser& parser) : depth(parser.depth_) {
      if (++depth > kMostInside)
        parser.fail(fmt::format("brackets and signs are nested more than {} deep", kMostInside));
    }
    ~Inside() { --depth; }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;
    int& depth;
  };

  Operand negation() {
    if (!take("not")) return comparison();
    const Inside inside(*this);
    Operand right = {[a = reference(negation())](const Lookup& l) -> Value { return !a(l); }};
    is_comparison_ = false;
    return right;
  }

  // A word must be one of the choices that it is compared with.
  Term compared(const Operand& operand, const Operand& with) const {
    if (operand.word.empty() || with.name.empty()) return settled(operand);
    std::vector<std::string> choices;
    const std::string& range = with.range;
    for (std::size_t from = 0; from <= range.size();) {
      const std::size_t bar = std::min(range.find(" | ", from), range.size());
      choices.push_back(range.substr(from, bar - from));
      from = bar + 3;
    }
    const bool free_text = range.find("file") != std::string::npos || range == "name";
    if (!free_text && std::find(choices.begin(), choices.end(), operand.word) == choices.end())
      fail(fmt::format("'{}' is not a value of {}: expected {}{}", operand.word, with.name, range,
                       tb::did_you_mean(tb::near_matches(operand.word, choices))));
    return [word = operand.word](const Lookup&) -> Value { return word; };
  }

  Operand comparison() {
    Operand left = sum();
    const std::string op = token_;
    if (op != "==" && op != "!=" && !is_order(op)) return left;
    next();
    const Operand right = sum();
    is_comparison_ = false;
    if (!is_order(op))
      return {[origin = origin_, a = compared(left, right), b = compared(right, left),
               equal = op == "=="](const Lookup& l) -> Value {
        const Value x = a(l), y = b(l);
        if (x.index() != y.index())
          origin->fail(fmt::format("{} is compared with {}", kind_of(x), kind_of(y)));
        return (x == y) == equal;
      }};
    const auto holds = [op](double x, double y) {
      if (op == "<") return x < y;
      if (op == "<=") return x <= y;
      return op == ">" ? x > y : x >= y;
    };
    violation_ = [a = number(left), b = number(right), holds](const Lookup& l) {
      const double x = a(l), y = b(l);
      if (holds(x, y)) return 0.0;
      const double off = std::fabs(x - y) / std::max(std::fabs(y), 1e-12);
      return std::isnan(off) ? std::numeric_limits<double>::infinity() : std::max(off, 1e-12);
    };
    is_comparison_ = true;
    return {[a = number(left), b = number(right), holds](const Lookup& l) -> Value {
      return holds(a(l), b(l));
    }};
  }

  Operand sum() {
    Operand left = product();
    while (token_ == "+" || token_ == "-") {
      const double sign = token_ == "+" ? 1 : -1;
      next();
      left = {[a = number(left), b = number(product()), sign](const Lookup& l) -> Value {
        return a(l) + sign * b(l);
      }};
    }
    return left;
  }

  Operand product() {
    Operand left = unary();
    while (token_ == "*" || token_ == "/" || token_ == "%") {
      const char op = token_[0];
      next();
      left = {
          [origin = origin_, a = number(left), b = number(unary()), op](const Lookup& l) -> Value {
            const double x = a(l), y = b(l);
            if (op == '*') return x * y;
            if (y == 0) throw DivisionByZero(origin->message("division by zero"));
            return op == '/' ? x / y : std::fmod(x, y);
          }};
    }
    return left;
  }

  Operand unary() {
    if (!take("-")) return value();
    const Inside inside(*this);
    return {[a = number(unary())](const Lookup& l) -> Value { return -a(l); }};
  }

  Operand value() {
    if (token_.empty()) fail("unexpected end");
    if (take("(")) {
      const Inside here(*this);
      Operand inner = disjunction();
      if (!take(")")) fail("a ')' is missing");
      return inner;
    }
    if (!in_name(token_[0])) fail(fmt::format("unexpected '{}'", token_));
    const std::string token = std::exchange(token_, "");
    next();
    if (const std::optional<std::string> range = known_.range(token)) {
      if (std::find(names_.begin(), names_.end(), token) == names_.end()) names_.push_back(token);
      return {[token](const Lookup& lookup) { return lookup(token); }, token, *range};
    }
    Value constant = value_of(token);
    if (!std::holds_alternative<std::string>(constant))
      return {[constant](const Lookup&) -> Value { return constant; }};
    return {nullptr, {}, {}, token};
  }

  std::shared_ptr<const Origin> origin_;
  const std::string& text_;
  const ExpressionNames& known_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::string token_;
  std::vector<std::string> names_;
  bool is_comparison_ = false;  // for the part parsed last
  std::function<double(const Lookup&)> violation_;
};

Expression::Expression(std::string text, std::string where, const ExpressionNames& names)
    : origin_(
          std::make_shared<Origin>(Origin{std::move(text), std::move(where), names.expression})) {
  Parser(origin_, names).parse(*this);
}

double Expression::number(const Lookup& lookup) const {
  return origin_->as<double>(term_(lookup), "a number");
}

bool Expression::reference(const Lookup& lookup) const {
  const Value value = term_(lookup);
  if (const bool* reference = std::get_if<bool>(&value)) return *reference;
  origin_->fail(fmt::format("it is {}, not true or false", kind_of(value)));
}

double Expression::violation(const Lookup& lookup) const {
  try {
    return violation_(lookup);
  } catch (const DivisionByZero&) {
    return std::numeric_limits<double>::infinity();
  }
}

namespace {

ExpressionNames parameters_of(const tb::ParameterSet& known) {
  return {"constraint", "a parameter",
          [&known](const std::string& name) -> std::optional<std::string> {
            const tb::Parameter* parameter = known.find(name);
            return parameter ? std::optional(parameter->range) : std::nullopt;
          },
          [&known](const std::string& name) { return known.near_matches(name); }};
}

}  // namespace

Constraint::Constraint(std::string text, std::string where, const tb::ParameterSet& known)
    : condition_(std::move(text), std::move(where), parameters_of(known)) {
  holds(known);  // evaluation errors already show with the defaults
}

bool Constraint::holds(const tb::ParameterSet& set) const {
  return condition_.reference(
      [&](const std::string& name) { return value_of(set.find(name)->text()); });
}

}  // namespace deburr::tool
