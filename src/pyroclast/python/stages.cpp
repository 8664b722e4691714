#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include <pybind11/stl.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/python/bindings.hpp"
#include "pyroclast/python/lent_body.hpp"
#include "pyroclast/simulation/coupling.hpp"

namespace pyroclast::python {

namespace {

/// Stage whose class is written in Python: pyroclast/stages.py says what it holds.
class PythonStage : public Stage {
 public:
  /// \param own  object of the class
  PythonStage(py::object own, std::string kind, StageNeeds needs, std::vector<Column> columns)
      : own_(shared(std::move(own))), kind_(std::move(kind)), needs_(needs), columns_(std::move(columns)) {}

  const char* kind() const override { return kind_.c_str(); }
  StageNeeds needs() const override { return needs_; }

  void begin(Simulation& simulation) override {
    with_body(simulation, [&](const py::object& body) { object().attr("begin")(body); });
  }
  bool advance(Simulation& simulation, int most_steps) override {
    return with_body(simulation, [&](const py::object& body) {
      return object().attr("advance")(body, most_steps).cast<bool>();
    });
  }
  Verdict judge(Simulation& simulation) override {
    return with_body(simulation, [&](const py::object& body) {
      const py::object said = object().attr("judge")(body);
      Verdict verdict;
      verdict.over = said.attr("over").cast<bool>();
      verdict.last = said.attr("last").cast<bool>();
      verdict.frame = said.attr("frame").cast<bool>();
      is_over_ = verdict.over;
      return verdict;
    });
  }
  double progress(const Simulation&) const override {
    const py::gil_scoped_acquire gil;
    return std::clamp(object().attr("progress")().cast<double>(), 0.0, 1.0);
  }

  std::vector<Column> columns() const override { return columns_; }
  std::vector<double> values() const override {
    const py::gil_scoped_acquire gil;
    auto values = object().attr("values")().cast<std::vector<double>>();
    if (values.size() != columns_.size())
      throw Error("stage \"" + kind_ + "\": values() gives " + std::to_string(values.size()) +
                  " numbers for " + std::to_string(columns_.size()) + " columns");
    return values;
  }

  StageReport report(const History&, RowRange, Outcome outcome) const override {
    StageReport report;
    if (outcome == Outcome::not_begun) return report;  // its class does not tell which results it will have
    const py::gil_scoped_acquire gil;
    for (const auto& [name, value] : object().attr("results")().cast<std::map<std::string, double>>())
      report.results.push_back({name, value});
    return report;
  }
  Forecast forecast(const Simulation&, Foreseen&) const override { return {}; }

  void visit_state(StateVisitor& visitor) override {
    visitor.visit("is_over", is_over_);
    const py::gil_scoped_acquire gil;
    std::string text;
    if (!visitor.replaces() && !is_over_) text = object().attr("_state_text")().cast<std::string>();
    visitor.visit("state", text);
    if (visitor.replaces() && !is_over_) object().attr("_take_state_text")(text);
  }

 private:
  const py::object& object() const { return *own_; }

  template <class Act>
  std::invoke_result_t<Act, const py::object&> with_body(Simulation& simulation, Act act) {
    const py::gil_scoped_acquire gil;
    const auto lent = std::make_shared<LentBody>(LentBody{&simulation});
    struct Return {
      LentBody& body;
      ~Return() { body.simulation = nullptr; }
    } at_the_end{*lent};
    return act(py::cast(lent));
  }

  std::shared_ptr<py::object> own_;
  std::string kind_;
  StageNeeds needs_;
  std::vector<Column> columns_;
  bool is_over_ = false;
};

/// Reads the value of a key that the class of a stage states, see stages.py.
py::object read_key(const Section& own, const py::handle& key) {
  const auto name = key.attr("name").cast<std::string>();
  const auto unit = key.attr("unit").cast<std::string>();
  const auto meaning_text = key.attr("meaning").cast<std::string>();
  const Meaning meaning(meaning_text);
  const py::object fallback = key.attr("default");
  if (unit == "text")
    return py::str(fallback.is_none() ? own.text(name, meaning)
                                      : own.text(name, fallback.cast<std::string>(), meaning));
  if (unit == "integer")
    return py::int_(fallback.is_none()
                        ? own.integer(name, Range::any(), meaning)
                        : own.integer(name, Range::any(), fallback.cast<long long>(), meaning));
  if (unit == "1")
    return py::float_(fallback.is_none() ? own.number(name, Range::any(), meaning)
                                         : own.number(name, Range::any(), fallback.cast<double>(), meaning));
  for (const Unit* kind : unit::all)
    if (unit == kind->si)
      return py::float_(fallback.is_none()
                            ? own.quantity(name, *kind, Range::any(), meaning)
                            : own.quantity(name, *kind, Range::any(), fallback.cast<double>(), meaning));
  throw Error("key \"" + name + "\" of a stage is in \"" + unit +
              "\", which is none of the SI units that decks know (pyroclast list units)");
}

StageKind kind_of(const py::object& type) {
  StageKind kind;
  kind.name = type.attr("kind").cast<std::string>();
  kind.meaning = py::str(type.attr("meaning"));
  kind.needs = {};
  std::vector<Column> columns;
  for (const auto& [name, unit] : type.attr("columns").cast<std::map<std::string, std::string>>())
    columns.push_back({name, unit});
  const auto held = shared(type);
  kind.read = [held, name = kind.name, needs = kind.needs, columns](
                  const Section& own, const StageTables&) -> std::unique_ptr<Stage> {
    const py::gil_scoped_acquire gil;
    const py::object stage = (*held)();
    for (const py::handle& key : stage.attr("_keys")())
      py::setattr(stage, key.attr("name"), read_key(own, key));
    return std::make_unique<PythonStage>(stage, name, needs, columns);
  };
  return kind;
}

}  // namespace

Simulation& LentBody::get() const {
  if (!simulation) throw Error("the body is lent to a stage for one call, and that call is over");
  return *simulation;
}

/// Returns the press. Throws Error where there is none.
Press& press_of(const LentBody& body) {
  if (!body.get().has_press()) throw Error("this body has no press: the deck has no table [platens]");
  return body.get().press();
}

StageRegistry kinds_with(const py::list& classes) {
  StageRegistry kinds;
  for (const py::handle& type : classes) kinds.add(kind_of(py::reinterpret_borrow<py::object>(type)));
  return kinds;
}

void bind_stages(py::module_& m) {
  using Press = pyroclast::Press;
  const auto press = [](auto method) {
    return [method](const LentBody& body) { return (press_of(body).*method)(); };
  };
  py::class_<LentBody, std::shared_ptr<LentBody>>(
      m, "Body",
      "The body and its press, lent to a stage for the time of one call. All is SI, temperatures in degC.")
      .def(
          "advance",
          [](const LentBody& body, int steps) {
            Simulation& simulation = body.get();
            if (steps < 0) throw Error("the number of steps must not be negative");
            const py::gil_scoped_release no_gil;
            simulation.motion().advance(steps);
          },
          py::arg("steps"), "Takes so many steps of the mechanics.")
      .def(
          "drive", [](const LentBody& body, double velocity) { press_of(body).control_by_motion(velocity); },
          py::arg("velocity"), "Moves the upper platen down at a velocity [m/s]; negative: up.")
      .def(
          "hold",
          [](const LentBody& body, double stress) {
            press_of(body).control_by_force();
            press_of(body).hold(stress);
          },
          py::arg("stress"), "Moves the upper platen by a force alone: a stress [Pa] times the area.")
      .def(
          "set_temperature",
          [](const LentBody& body, double temperature) {
            Simulation& simulation = body.get();
            simulation.field().set_uniform(temperature);
            simulation.hand_over();
          },
          py::arg("temperature"),
          "Another temperature [degC] of the whole specimen, handed to the mechanics.")
      .def_property_readonly("strain", press(&Press::strain), "Of the test, positive in compression [1].")
      .def_property_readonly("stress", press(&Press::stress),
                             "Mean of both platens, compression positive [Pa].")
      .def_property_readonly("gap", press(&Press::gap), "Between platens and specimen [m].")
      .def_property_readonly("height", press(&Press::height), "Of the specimen [m].")
      .def_property_readonly(
          "temperature", [](const LentBody& body) { return body.get().field().mean(); },
          "Mean of the specimen [degC].")
      .def_property_readonly(
          "time_step", [](const LentBody& body) { return body.get().motion().time_step(); },
          "Of the mechanics [s].")
      .def_property_readonly(
          "steps", [](const LentBody& body) { return body.get().motion().steps(); },
          "Of the mechanics so far.")
      .def_property_readonly(
          "unbalanced_ratio",
          [](const LentBody& body) { return body.get().motion().totals().unbalanced_ratio(); },
          "Mean unbalanced force over mean force [1].");
}

}  // namespace pyroclast::python
