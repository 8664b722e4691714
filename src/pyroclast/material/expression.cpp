#include "pyroclast/material/expression.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <map>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/shown.hpp"

namespace pyroclast {
namespace {

/// Returns muParser's error in the words of this project; the position is counted from 1.
/// \param known  words for the names that a formula may use
Error formula_error(const std::string& formula, const std::string& known,
                    const mu::Parser::exception_type& error) {
  static const std::map<mu::EErrorCodes, const char*> explanations = {
      {mu::ecUNEXPECTED_OPERATOR, "an operator does not belong here"},
      {mu::ecUNEXPECTED_EOF, "the formula ends too early"},
      {mu::ecUNEXPECTED_ARG_SEP, "a comma does not belong here"},
      {mu::ecUNEXPECTED_VAL, "a number does not belong here; an operator may be missing before it"},
      {mu::ecUNEXPECTED_VAR, "the variable does not belong here; an operator may be missing before it"},
      {mu::ecUNEXPECTED_FUN, "a function does not belong here; an operator may be missing before it"},
      {mu::ecUNEXPECTED_PARENS, "a parenthesis does not belong here"},
      {mu::ecMISSING_PARENS, "a closing parenthesis is missing"},
      {mu::ecTOO_MANY_PARAMS, "the function has too many arguments"},
      {mu::ecTOO_FEW_PARAMS, "the function has too few arguments"},
  };
  if (error.GetCode() == mu::ecEMPTY_EXPRESSION) return Error("the formula is empty");
  std::string what = shown_in_short(error.GetMsg());
  if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN) {
    what = fmt::format("\"{}\" is not known; {}, functions are e.g. exp, ln, sqrt, min, max",
                       shown_in_short(error.GetToken()), known);
  } else if (const auto it = explanations.find(error.GetCode()); it != explanations.end()) {
    what = it->second;
  }
  // muParser works on a copy with a blank at the end.
  const auto position = std::min<std::size_t>(error.GetPos(), formula.size()) + 1;
  return Error(fmt::format("formula \"{}\", character {}: {}", shown_in_short(formula), position, what));
}

/// Throws Error for a formula that assigns to its variable, as muParser lets it do.
void refuse_statements(const std::string& formula) {
  constexpr std::string_view comparison = "=!<>";
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (formula[i] != '=') continue;
    const bool closes = i > 0 && comparison.find(formula[i - 1]) != std::string_view::npos;
    const bool opens = i + 1 < formula.size() && formula[i + 1] == '=';
    if (!closes && !opens) {
      throw Error(fmt::format(
          "formula \"{}\", character {}: \"=\" assigns, which a formula cannot do; equality is \"==\"",
          shown_in_short(formula), i + 1));
    }
  }
}

void set_formula(mu::Parser& parser, const std::string& formula) {
  // Where && and || stand between constants, muParser's optimizer casts them to int: 0.5 && 1 is false to
  // it, and what does not fit into an int is undefined.
  if (formula.find("&&") != std::string::npos || formula.find("||") != std::string::npos)
    parser.EnableOptimizer(false);
  parser.SetExpr(formula);
}

void require_one_value(const std::string& formula, int count) {
  if (count != 1)
    throw Error(fmt::format(
        "formula \"{}\" has {} values separated by commas, one is wanted; the decimal sign is a point",
        shown_in_short(formula), count));
}

/// Parser with the variable that it reads.
class Evaluator {
 public:
  Evaluator(const std::string& formula, const std::string& variable) {
    parser_.DefineVar(variable, &x_);
    set_formula(parser_, formula);
  }
  Evaluator(const Evaluator&) = delete;
  Evaluator& operator=(const Evaluator&) = delete;

  double evaluate(double x) {
    x_ = x;
    return parser_.Eval();
  }
  int result_count() const { return parser_.GetNumResults(); }

 private:
  double x_ = 0.0;
  mu::Parser parser_;
};

/// Place for one evaluator, on a cache line of its own.
struct alignas(64) Slot {
  std::atomic_flag busy;
  std::unique_ptr<Evaluator> evaluator;
};

/// Exclusive use of a slot for the lifetime of the object.
class SlotGuard {
 public:
  explicit SlotGuard(Slot& slot) : slot_(slot) {
    while (slot_.busy.test_and_set(std::memory_order_acquire)) std::this_thread::yield();
  }
  ~SlotGuard() { slot_.busy.clear(std::memory_order_release); }
  SlotGuard(const SlotGuard&) = delete;
  SlotGuard& operator=(const SlotGuard&) = delete;

 private:
  Slot& slot_;
};

/// Returns the running number of the calling thread.
std::size_t thread_number() {
  static std::atomic<std::size_t> next{0};
  thread_local const std::size_t number = next++;
  return number;
}

}  // namespace

/// Evaluators of one formula. Threads are dealt out to the slots by their number, so that in practice each
/// has a slot to itself. Two threads that meet on one slot take turns.
struct Expression::Evaluators {
  std::string formula;
  std::string variable;
  std::array<Slot, 64> slots;
};

Expression::Expression(std::string formula, std::string variable)
    : evaluators_(std::make_unique<Evaluators>()) {
  evaluators_->formula = std::move(formula);
  evaluators_->variable = std::move(variable);
  refuse_statements(evaluators_->formula);
  try {
    Evaluator trial(evaluators_->formula, evaluators_->variable);
    trial.evaluate(1.0);
    require_one_value(evaluators_->formula, trial.result_count());
  } catch (const mu::Parser::exception_type& error) {
    throw formula_error(evaluators_->formula, "the variable is " + evaluators_->variable, error);
  }
}

Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;

double Expression::operator()(double x) const {
  Slot& slot = evaluators_->slots[thread_number() % evaluators_->slots.size()];
  const SlotGuard guard(slot);
  if (!slot.evaluator)
    slot.evaluator = std::make_unique<Evaluator>(evaluators_->formula, evaluators_->variable);
  return slot.evaluator->evaluate(x);
}

double evaluate(const std::string& formula, const std::map<std::string, double>& values) {
  refuse_statements(formula);
  try {
    mu::Parser parser;
    for (const auto& [name, value] : values) parser.DefineConst(name, value);
    set_formula(parser, formula);
    const double result = parser.Eval();
    require_one_value(formula, parser.GetNumResults());
    return result;
  } catch (const mu::Parser::exception_type& error) {
    std::vector<std::string> names;
    for (const auto& [name, value] : values) names.push_back(name);
    throw formula_error(formula, fmt::format("names are {}", fmt::join(names, ", ")), error);
  }
}

bool is_name_in_formulas(const std::string& text) {
  try {
    mu::Parser parser;
    parser.DefineConst(text, 1.0);
    parser.SetExpr(text);
    return parser.Eval() == 1.0;
  } catch (const mu::Parser::exception_type&) {
    return false;
  }
}

}  // namespace pyroclast
