#include <atomic>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <unistd.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/processors.hpp"
#include "pyroclast/python/arrays.hpp"
#include "pyroclast/python/bindings.hpp"
#include "pyroclast/python/decks.hpp"
#include "pyroclast/python/specimens.hpp"
#include "pyroclast/session/rehearsal.hpp"
#include "pyroclast/simulation/coupling.hpp"
#include "pyroclast/stages/possible_columns.hpp"

namespace pyroclast::python {

namespace {

/// Time between two questions to the interpreter for signals. It is not asked at every batch: to get its lock
/// may take milliseconds while another thread computes.
constexpr std::chrono::milliseconds kBetweenSignals{50};

/// Session as Python holds it: for one thread at a time, in the process that made it.
class Held {
 public:
  explicit Held(std::unique_ptr<Session> session) : session_(session.release(), Leave{getpid()}) {
    session_->stop_when([this] { return is_to_stop(); });
  }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;

  /// Returns the session to be read. Throws Error in another process, and while another thread is in `next`.
  Session& get() const {
    require_own_process();
    if (const auto thread = stepping_.load();
        thread != std::thread::id() && thread != std::this_thread::get_id())
      throw Error("this run is stepping in another thread; stepping belongs to one at a time");
    return *session_;
  }
  /// Returns the session to be changed. Throws Error also in a call-back of `next`.
  Session& resting() const {
    Session& session = get();
    if (stepping_.load() != std::thread::id())
      throw Error(
          "a call-back between steps may read the run and stop it; change the run after it has stopped");
    return session;
  }

  bool next() {
    Session& session = resting();
    if (closed_) throw Error("this run was closed");
    if (broken_)
      throw Error("this run was ended by an error and cannot go on; copy an earlier state, or resume");
    const Stepping stepping(stepping_);
    bool is_there = false;
    broken_ = true;
    {
      const py::gil_scoped_release no_gil;
      is_there = session.next();
    }
    broken_ = false;
    if (!is_there || raised_) stop_ = false;  // the stop was heard
    if (!raised_) return is_there;
    std::exchange(raised_, nullptr)->restore();
    throw py::error_already_set();
  }

  void call_at(std::int64_t step, const py::function& call) {
    get().run().call_at(step, [this, held = shared(call)](Run&) {
      const py::gil_scoped_acquire gil;
      if (raised_) return;
      try {
        (*held)();
      } catch (py::error_already_set& error) {
        raise(error);
      }
    });
  }
  void stop(bool wanted) { stop_ = wanted; }
  /// Writes the summary of the run, and unlocks its folder.
  void close() {
    if (closed_) return;
    Session& session = resting();
    session.finish();
    session.leave_folder();
    closed_ = true;
  }

 private:
  /// Deleter that leaves the session alone in a child of fork: the threads of the run are not there, and its
  /// end would wait for them.
  struct Leave {
    pid_t maker;
    void operator()(Session* session) const {
      if (getpid() == maker) delete session;
    }
  };
  struct Stepping {
    explicit Stepping(std::atomic<std::thread::id>& thread) : thread_(thread) {
      thread_ = std::this_thread::get_id();
    }
    ~Stepping() { thread_ = std::thread::id(); }
    std::atomic<std::thread::id>& thread_;
  };

  void require_own_process() const {
    if (getpid() != session_.get_deleter().maker)
      throw Error(
          "this run belongs to the process that made it, and its threads did not come along into this child "
          "of fork: make runs in processes that are started by spawn, as pyroclast.parallel.map_runs and "
          "multiprocessing.get_context(\"spawn\") do");
  }

  bool is_to_stop() {
    if (stop_ || raised_) return true;
    const auto now = std::chrono::steady_clock::now();
    if (now - asked_at_ < kBetweenSignals) return false;
    asked_at_ = now;
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() == 0) return false;
    py::error_already_set error;
    raise(error);
    return true;
  }
  void raise(py::error_already_set& error) {
    raised_ = std::make_unique<py::error_already_set>(error);
    stop_ = true;
  }

  std::unique_ptr<Session, Leave> session_;
  std::atomic<std::thread::id> stepping_{std::thread::id()};
  std::atomic<bool> stop_{false};
  bool broken_ = false, closed_ = false;
  std::unique_ptr<py::error_already_set> raised_;
  std::chrono::steady_clock::time_point asked_at_;
};

std::optional<RunOutput> output(const std::optional<std::string>& folder, bool overwrite) {
  if (!folder) return std::nullopt;
  return RunOutput{*folder, overwrite, "a script, by the package for Python",
                   "choose another folder by out, or say overwrite=True"};
}

RunChoices choices(const std::optional<std::uint64_t>& seed, int threads, const std::string& instructions,
                   const std::optional<double>& checkpoint, const std::vector<std::string>& laws,
                   const py::list& stages) {
  RunChoices c;
  c.seed = seed;
  c.threads = threads;
  c.instructions = instructions;
  c.checkpoint = checkpoint;
  c.kinds = kinds_with(stages);
  c.laws = law_sources(laws);
  return c;
}

/// Makes a session without the interpreter's lock, because that takes long; stages of Python take the lock
/// themselves.
template <class Make>
std::unique_ptr<Held> held(Make make) {
  std::unique_ptr<Session> session;
  {
    const py::gil_scoped_release no_gil;
    session = make();
  }
  return std::make_unique<Held>(std::move(session));
}

/// Returns kind, outcome and rows of a stage: its first row, and the one behind its last.
py::tuple stage_info(const Run& run, std::size_t i) {
  const StageCourse& record = run.courses()[i];
  return py::make_tuple(run.stages()[i]->kind(), describe(record.outcome), record.rows.first,
                        record.rows.last);
}

/// Returns a binding of a function of the session, to be read.
template <class Function>
auto reading(Function f) {
  return [f](const Held& h) { return f(h.get()); };
}

/// Binds what makes a run, takes it on, changes it and ends it.
void bind_stepping(py::class_<Held>& bound) {
  using py::arg;
  bound
      .def_static(
          "begin",
          [](const DeckText& deck, std::optional<std::uint64_t> seed, int threads,
             const std::string& instructions, std::optional<double> checkpoint,
             const std::optional<std::string>& out, bool overwrite, const std::string& body) {
            auto chosen = choices(seed, threads, instructions, checkpoint, deck.laws, deck.stages);
            chosen.laws = law_sources(deck);
            chosen.body = body;
            return held([&] {
              return Session::begin({parse(deck), deck.folder, chosen}, output(out, overwrite));
            });
          },
          arg("deck"), arg("seed"), arg("threads"), arg("instructions"), arg("checkpoint"), arg("out"),
          arg("overwrite"), arg("body"))
      .def_static(
          "resume",
          [](const std::string& folder, const std::string& checkpoint, int threads,
             const std::vector<std::string>& laws, const py::list& stages) {
            const auto chosen = choices({}, threads, "", {}, laws, stages);
            return held([&] { return Session::resume(folder, checkpoint, chosen); });
          },
          arg("folder"), arg("checkpoint"), arg("threads"), arg("laws"), arg("stages"))
      .def_static(
          "fork",
          [](const std::string& folder, const std::string& from_stage, const std::string& more,
             const std::vector<std::string>& changes, const std::string& out, bool overwrite, int threads,
             const std::vector<std::string>& laws, const py::list& stages) {
            const auto chosen = choices({}, threads, "", {}, laws, stages);
            return held([&] {
              return Session::fork({folder, from_stage, more, changes}, *output(out, overwrite), chosen);
            });
          },
          arg("folder"), arg("from_stage"), arg("more"), arg("changes"), arg("out"), arg("overwrite"),
          arg("threads"), arg("laws"), arg("stages"))
      .def("next", &Held::next, "Goes on to the next sample; False when the run is over or was stopped.")
      .def("close", &Held::close, "Writes the summary of the run, and unlocks its folder.")
      .def("stop", &Held::stop, arg("wanted") = true,
           "Stops the run at the next end of a batch of steps, or takes that back.")
      .def("call_at", &Held::call_at, arg("step"), arg("call"),
           "Calls back once, at a step of the mechanics.")
      .def(
          "finish",
          [](const Held& h) {
            Session& session = h.resting();
            return summary_text(session.finish(), session.run());
          },
          "summary.json of the rows so far, written where there is a folder.")
      .def(
          "copy",
          [](const Held& h, const std::vector<std::string>& changes, const std::optional<std::string>& out,
             bool overwrite) {
            Session& session = h.resting();
            return held([&] { return session.copy(changes, output(out, overwrite)); });
          },
          arg("changes"), arg("out"), arg("overwrite"))
      .def("write_checkpoint", [](const Held& h) { h.resting().write_checkpoint(); })
      .def(
          "change_stages",
          [](const Held& h, const std::vector<std::string>& changes, const std::string& more) {
            h.resting().change_stages(changes, more);
          },
          arg("changes"), arg("more"))
      .def(
          "change_materials",
          [](const Held& h, const std::vector<std::string>& changes) {
            h.resting().change_materials(changes);
          },
          arg("changes"))
      .def("end_stage", [](const Held& h) { h.resting().end_stage(); })
      .def(
          "set_temperature",
          [](const Held& h, double temperature) { h.resting().set_temperature(temperature); },
          arg("temperature"))
      .def(
          "drive", [](const Held& h, const std::string& drives) { h.resting().drive(drives); }, arg("drives"),
          "Tables [[drives]] that act from now on.")
      .def(
          "depart",
          [](const Held& h, const std::string& why) {
            h.resting().depart({why, false});
          },
          arg("why"), "Notes that the run needs more than its deck.");
}

/// Binds what a run is and where it stands: its deck, its stages, its history.
void bind_state(py::class_<Held>& bound) {
  using py::arg;
  bound
      .def(
          "summary",
          [](const Held& h) {
            const Session& session = h.get();
            return summary_text(session.summary(), session.run());
          },
          "The text of the summary, not written.")
      .def(
          "summary_numbers", [](const Held& h) { return h.get().summary_numbers(); },
          "Entries that may be numbers in the summary when the run is over: results by name, others by path.")
      .def(
          "test_results", [](const Held& h) { return test_results(h.get().run()); },
          "Results that a laboratory would report, by name.")
      .def_property_readonly("outcome", reading([](const Session& s) { return describe(s.run().outcome()); }))
      .def_property_readonly("is_over", reading([](const Session& s) {
                               return s.run().outcome() != Outcome::running &&
                                      s.run().outcome() != Outcome::stopped;
                             }))
      .def_property_readonly("stage", reading([](const Session& s) { return s.run().stage_number(); }))
      .def_property_readonly("stages", reading([](const Session& s) {
                               py::list all;
                               for (std::size_t i = 0; i < s.run().stages().size(); ++i)
                                 all.append(stage_info(s.run(), i));
                               return all;
                             }),
                             "Kind, outcome, first and last row of each.")
      .def_property_readonly("rows", reading([](const Session& s) { return s.run().history().row_count(); }))
      .def_property_readonly("columns", reading([](const Session& s) {
                               py::list all;
                               for (const Column& c : s.run().history().columns())
                                 all.append(py::make_tuple(c.name, c.unit));
                               return all;
                             }),
                             "Name and unit of each.")
      .def("history", reading([](const Session& s) { return table(s.run().history()); }),
           "(rows, columns), in the units of the columns; NaN where a cell is empty.")
      .def("row", reading([](const Session& s) {
             const History& history = s.run().history();
             if (history.row_count() == 0) throw Error("the run has no sample yet");
             return row(history.row(history.row_count() - 1));
           }),
           "The last row, (columns,).")
      .def(
          "measure", [](const Held& h) { return row(h.get().run().measure()); },
          "Row that a sample would measure now, (columns,).")
      .def_property_readonly("step",
                             [](const Held& h) -> std::int64_t {
                               const Simulation& s = h.get().simulation();
                               return s.moves() ? s.motion().steps() : 0;
                             })
      .def_property_readonly("moves", [](const Held& h) { return h.get().simulation().moves(); })
      .def_property_readonly("thickness",
                             [](const Held& h) { return h.get().simulation().model().thickness; })
      .def_property_readonly("title", reading([](const Session& s) { return s.opened().setup.title; }))
      .def_property_readonly("seed", reading([](const Session& s) { return s.opened().setup.specimen.seed; }))
      .def_property_readonly("deck_text", reading([](const Session& s) { return s.opened().deck.text(); }))
      .def_property_readonly("warnings", reading([](const Session& s) { return s.opened().warnings; }))
      .def_property_readonly("folder", reading([](const Session& s) { return s.folder().string(); }))
      .def_property(
          "threads", [](const Held& h) { return h.get().simulation().team().size(); },
          [](const Held& h, int threads) { h.resting().simulation().team().resize(usable_threads(threads)); })
      .def_property_readonly("deck_folder",
                             reading([](const Session& s) { return s.opened().folder.string(); }));
}

/// Binds fields and sets of the body.
void bind_arrays(py::class_<Held>& bound) {
  using py::arg;
  bound
      .def_property_readonly("material_names",
                             [](const Held& h) { return h.get().simulation().model().material_names; })
      .def(
          "view",
          [](const py::object& self, const std::string& what) {
            return view(self.cast<const Held&>().get().simulation(), what, self);
          },
          arg("what"), "An array as it lies in memory, read-only; keeps the run alive.")
      .def(
          "copied", [](const Held& h, const std::string& what) { return copied(h.get().simulation(), what); },
          arg("what"), "An array of the mesh in the order of the model, as a copy.")
      .def("field_infos",
           [](const Held& h) {
             std::vector<py::tuple> all;
             const Simulation& simulation = h.get().simulation();
             const int dimension = simulation.model().dimension();
             for (const Field& f : fields_of(simulation))
               all.push_back(py::make_tuple(name_with_unit(f), f.name, f.unit.si, name_of(f.item),
                                            components_of(f.kind, dimension), f.meaning));
             return all;
           })
      .def(
          "fields",
          [](const Held& h, const std::string& item, const std::vector<std::string>& names) {
            return fields(h.get().simulation(), item_of(item), names);
          },
          arg("item"), arg("names"), "Fields of one item now, by their names with units.")
      .def(
          "set_names",
          [](const Held& h, bool of_contacts) {
            const Model& model = h.get().simulation().model();
            std::vector<std::string> names;
            for (const auto& [name, all] : of_contacts ? model.contact_sets : model.sets)
              names.push_back(name);
            return names;
          },
          arg("of_contacts"))
      .def(
          "members",
          [](const Held& h, const std::string& set, bool of_contacts) {
            return members(h.get().simulation(), set, of_contacts);
          },
          arg("set"), arg("of_contacts"))
      .def_property_readonly("specimen",
                             [](const Held& h) {
                               const auto& specimen = h.get().simulation().specimen();
                               if (!specimen)
                                 throw Error(
                                     "the body of this run was read from body.h5, which does not hold its "
                                     "specimen; Deck.make_specimen makes it");
                               return PythonSpecimen{*specimen};
                             })
      .def("contact_points", [](const Held& h) { return contact_points(h.get().simulation()); })
      .def("found_points", [](const Held& h) { return found_points(h.get().simulation()); });
}

}  // namespace

void bind_sessions(py::module_& m) {
  using py::arg;
  m.def(
      "possible_fields",
      [] {
        std::vector<py::tuple> all;
        for (const FieldInfo& f : possible_fields())
          all.push_back(py::make_tuple(f.name, product_of(f.unit), name_of(f.item), components_of(f.kind, 2),
                                       f.meaning, f.in_files));
        return all;
      },
      "Fields that runs may have: name, unit as in files, item, components, meaning, whether files hold it.");
  m.def(
      "possible_columns",
      [] {
        std::vector<py::tuple> all;
        for (const Column& c : possible_columns())
          all.push_back(
              py::make_tuple(c.name, c.unit, c.label, c.meaning, name_of(c.role), c.of, c.mode, c.interface));
        return all;
      },
      "Columns that histories may have: name, unit, label, meaning, role, quantity, mode and interface of "
      "cracks.");
  m.def(
      "seconds_of_run",
      [](const DeckText& deck, std::optional<std::uint64_t> seed) {
        auto chosen = choices(seed, 1, "", {}, deck.laws, deck.stages);
        chosen.laws = law_sources(deck);
        DeckOfRun opened(parse(deck), deck.folder, chosen);
        const auto simulation = make_simulation(opened.setup, opened.team);
        return rehearse(std::move(opened.setup), *simulation).seconds;
      },
      arg("deck"), arg("seed"),
      "Wall time that a run of one thread will probably take, s, by its first steps.");
  py::class_<Held> session(m, "Session",
                           "A run with its deck, its simulation and, where it has one, its folder.");
  bind_stepping(session);
  bind_state(session);
  bind_arrays(session);
}

}  // namespace pyroclast::python
