#include <memory>

#include <fmt/format.h>

#include "pyroclast/app/on_ranks.hpp"
#include "pyroclast/app/run_to_end.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/shell_words.hpp"
#include "pyroclast/results/text_file.hpp"
#include "pyroclast/version.hpp"

namespace pyroclast::app {

namespace {

struct ResumeOptions {
  std::filesystem::path run;         ///< folder of a run
  std::filesystem::path checkpoint;  ///< checkpoint to go on from; empty: the newest
  std::string from_stage;            ///< number or name of the last stage in common, for a fork
  std::filesystem::path more;        ///< file with stages to append, for a fork
  RunOptions as;                     ///< options of the run; `deck` and `seed` come from the run itself
};

void say_lost_frames(RunLog& log, const Session& session) {
  for (const std::string& line : session.lost_frames()) log.say(fmt::format("{:<16}{}", "warning", line));
}

int go_on(const ResumeOptions& options) {
  const auto session = Session::resume(options.run, options.checkpoint, choices_of(options.as));
  const CheckpointInfo& from = *session->goes_on_from();
  const std::filesystem::path file = session->last_checkpoint().filename();
  const Run& run = session->run();
  RunLog log(file_in(session->folder(), "run.log"), options.as.speech, from.log_bytes);
  log.say_now(fmt::format("goes on from {}, step {}, stage {} of {}", file.string(), from.step,
                          run.stage_number() + 1, run.stages().size()));
  if (from.commit != kCommit)
    log.say(fmt::format("                it was written by another build, of commit {}", from.commit));
  say_lost_frames(log, *session);
  return run_to_end(*session, log, options.as);
}

int fork(const ResumeOptions& options) {
  const auto session =
      Session::fork({options.run, options.from_stage, options.more, options.as.changes},
                    {options.as.out, options.as.overwrite, options.as.command}, choices_of(options.as));
  print_kept(options.as.out, session->foreign());
  RunLog log(file_in(session->folder(), "run.log"), options.as.speech);
  log.say(fmt::format("fork            of {}, from the end of stage {}", options.run.string(),
                      session->run().last_begun_stage()));
  log.say(describe_start(*session));
  say_lost_frames(log, *session);
  return run_to_end(*session, log, options.as);
}

int go_on_or_fork(const ResumeOptions& options) {
  RunFolder::require(options.run);
  const bool forks = !options.from_stage.empty() || !options.more.empty();
  if (forks && options.as.out.empty()) throw Error("a fork needs a folder of its own: --out NEW");
  if (!forks && !options.as.changes.empty())
    throw Error("--set: a resumed run cannot change; fork it with the change: --from-stage K --out NEW");
  if (!forks && !options.as.out.empty())
    throw Error("--out: a run goes on in its own folder; a fork needs --from-stage or --stages");
  return forks ? fork(options) : go_on(options);
}

}  // namespace

Command add_resume(CLI::App& cli) {
  const auto options = std::make_shared<ResumeOptions>();
  auto* resume = cli.add_subcommand(
      "resume", "Continue an interrupted run, or fork one: keep its first stages and append others");
  resume->add_option("RUN", options->run, "Folder of a run")->required();
  resume->add_option("--checkpoint-file", options->checkpoint,
                     "Continue from this checkpoint, not from the newest");
  auto* from_stage = resume->add_option("--from-stage", options->from_stage,
                                        "Fork: the last stage in common, by its number from 0 or its name");
  resume->add_option("--stages", options->more, "Fork: append the [[stages]] of this file")
      ->excludes(from_stage);
  add_changes(resume, options->as);
  add_output(resume, options->as);
  add_page(resume, options->as);
  add_processor(resume, options->as);
  add_own_laws(resume, options->as.laws);
  add_checkpoint(resume, options->as);
  add_speech(resume, options->as);
  add_watching(resume, options->as);
  add_mpi(resume, options->as);
  return {resume,
          [options](const std::vector<std::string>& typed) {
            options->as.command = shell_command(typed);
            if (options->as.mpi) return run_on_ranks(options->as, [&] { return go_on_or_fork(*options); });
            require_one_copy("say --mpi, and they hold parts of one body");
            return go_on_or_fork(*options);
          },
          false};
}

}  // namespace pyroclast::app
