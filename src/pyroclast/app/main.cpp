#include <algorithm>
#include <csignal>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "pyroclast/app/command_names.hpp"
#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/on_ranks.hpp"
#include "pyroclast/base/environment.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/physics_version.hpp"
#include "pyroclast/mechanics/instruction_set.hpp"
#include "pyroclast/version.hpp"

namespace {

using namespace pyroclast;

/// Commands in the order of the help.
constexpr app::Command (*const kCommands[])(CLI::App&) = {
    app::add_run,        app::add_check,   app::add_specimen, app::add_resume,     app::add_law,
    app::add_properties, app::add_figures, app::add_report,   app::add_watch,      app::add_study,
    app::add_converge,   app::add_new,     app::add_concrete, app::add_keys,       app::add_laws,
    app::add_list,       app::add_doctor,  app::add_manual,   app::add_completion, app::add_commands};

int command_line(int argc, char** argv) {
  CLI::App cli{"Pyroclast: how concrete breaks under load and fire, by the discrete element method",
               "pyroclast"};
  cli.set_version_flag("--version",
                       fmt::format("pyroclast {} ({}), physics version {}, instruction sets {}", kVersion,
                                   kCommit, kPhysicsVersion, describe_built_instruction_sets()));
  cli.require_subcommand(1);
  std::vector<app::Command> commands;
  for (const auto add : kCommands) commands.push_back(add(cli));
  try {
    cli.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return cli.exit(error);  // --help, --version
    throw Error(app::what_is_wrong(cli, error, std::vector<std::string>(argv + 1, argv + argc)));
  }
  const auto asked =
      std::ranges::find_if(commands, [](const app::Command& each) { return bool(*each.line); });
  const int code = asked->act({argv, argv + argc});
  return asked->must_print ? app::printed(code) : code;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that must not grow further is an error with a sentence
  forget_current_folder();
  try {
    return command_line(argc, argv);
  } catch (...) {
    return app::tell_failure();
  }
}
