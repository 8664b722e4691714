#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "in_plane.hpp"
#include "mechanics/bodies.hpp"
#include "messages.hpp"
#include "own_folder.hpp"
#include "pyroclast/laws/registry.hpp"
#include "pyroclast/plugin/find_law.hpp"
#include "pyroclast/plugin/open_library.hpp"
#include "pyroclast/plugin/stamp.hpp"
#include "stages/small_runs.hpp"

namespace pyroclast {
namespace {

namespace fs = std::filesystem;

/// Whether a text holds all the words.
testing::AssertionResult says(const std::string& text, const std::vector<std::string>& words) {
  for (const auto& word : words)
    if (text.find(word) == std::string::npos)
      return testing::AssertionFailure() << '"' << word << "\" is not in:\n" << text;
  return testing::AssertionSuccess();
}

fs::path law_file(const std::string& name) {
  return fs::path(LAWS) / (name + ".so");
}

std::string refusal_of(const std::string& name) {
  return message([&] { open_law(law_file("refused_" + name)); });
}

TEST(Plugin, ASharedObjectThatIsNoLawIsRefused) {
  EXPECT_TRUE(says(refusal_of("symbol"), {"refused_symbol.so", "no symbol pyroclast_law_v1"}));
  EXPECT_TRUE(says(refusal_of("magic"), {"does not give a contact law"}));
  EXPECT_TRUE(says(message([] { open_law(fs::path(HEADERS) / "small.hpp"); }),
                   {"small.hpp", "cannot be loaded as a contact law"}));
}

TEST(Plugin, ALawForAnotherVersionOrLayoutIsRefusedWithBothValues) {
  EXPECT_TRUE(says(refusal_of("table"), {"form 1000", "takes form 1 "}));
  EXPECT_TRUE(says(refusal_of("version"), {"pyroclast 0.0.1;", "build it again"}));
  EXPECT_TRUE(says(refusal_of("layout"), {"another layout", "with 8 lanes"}));
}

TEST(Plugin, ALawThatBearsTheNameOfOneOfTheProgramIsRefused) {
  EXPECT_TRUE(says(message([] { find_law("refused_name", LAWS, {}, true); }),
                   {"refused_name.so", "called \"cohesive\""}));
}

TEST(Plugin, FastMathIsRefused) {
  EXPECT_TRUE(says(refusal_of("fast_math"), {"-ffast-math"}));
}

#ifdef X86
TEST(Plugin, ContractionIsRefused) {
  if (!__builtin_cpu_supports("fma")) GTEST_SKIP() << "this processor contracts nothing";
  EXPECT_TRUE(says(refusal_of("contraction"), {"contraction", "-ffp-contract=off"}));
}

TEST(Plugin, FlushToZeroIsRefusedAndUndone) {
  EXPECT_TRUE(says(refusal_of("flush"), {"MXCSR"}));
  volatile double least = std::numeric_limits<double>::min();
  EXPECT_GT(0.5 * least, 0.0);
}
#endif

struct NoArrays {
  template <class... A>
  static void each(A&&...) {}
};
/// What a law's rows see of a body, less its arrays: as it is, and with two numbers that changed places.
struct Seen : NoArrays {
  Vec<2> gravity;
  double time_step, thickness;
  Kinematics kinematics;
  const LawTable* const* laws;
  NoArrays layout;
};
struct SeenOtherwise : NoArrays {
  Vec<2> gravity;
  double thickness, time_step;
  Kinematics kinematics;
  const LawTable* const* laws;
  NoArrays layout;
};

// Promise: two numbers of a state that changed places are noticed before a law reads one for the other.
TEST(Plugin, TheLayoutTellsWhereNumbersOfAStateStand) {
  LayoutHash seen, again, otherwise;
  add_state<2, Seen>(seen);
  add_state<2, Seen>(again);
  add_state<2, SeenOtherwise>(otherwise);
  EXPECT_EQ(seen.value(), again.value());
  EXPECT_NE(seen.value(), otherwise.value());
}

TEST(Plugin, ALoadedLawIsATableLikeAnyOther) {
  const OpenedLaw& law = open_law(law_file("renamed"));
  EXPECT_STREQ(law.table.name, "renamed");
  EXPECT_EQ(law.dimensions, Dimensions::both);
  EXPECT_FALSE(law.compiler.empty());
  const auto paper = mortar_contact();
  const int own = count_of<Cohesive::Properties<double>>();
  ASSERT_EQ(law.table.properties.size(), own + 1);
  EXPECT_STREQ(law.table.properties[own].key, "u_mark");
  EXPECT_EQ(law.table.internals(2).size(), (count_of<Cohesive::Internals<2, double>>()) + 1);
  EXPECT_EQ(law.table.losses.size(), count_of<Cohesive::Losses<double>>() + 1);
  EXPECT_EQ(&open_law(law_file("renamed")), &law) << "a file is loaded once";

  // torn apart in one go
  std::vector<double> numbers(own + 1);
  put(paper, numbers.data());
  ContactProperties p(law.table, numbers, std::vector<int>(law.table.choices.size()));
  EXPECT_NO_THROW(validate(p, "contact"));
  p.numbers[own] = -1.0;
  EXPECT_TRUE(says(message([&] { validate(p, "contact"); }), {"u_mark (m) = -1"}));
  const auto constants = p.constants();
  std::vector<double> internals(law.table.internals(2).size()), losses(law.table.losses.size());
  const std::array jump{1e-4, 0.0};
  law.table.update(2)(constants.data(), jump.data(), internals.data(), losses.data());
  EXPECT_DOUBLE_EQ(losses[1], paper.mode_1_energy);
  EXPECT_EQ(internals.back(), 1e-4);
  EXPECT_EQ(losses.back(), 1.0);
}

/// A small body whose mortar creeps under load, with contacts of a law.
std::unique_ptr<Simulation> creeping_body(const std::string& law, const LawSources& sources) {
  std::string text = with(deck(kUniform + kSettle + load("stress = \"1 MPa\"") + heat("60 degC") + kCompress),
                          "[contacts.mortar_mortar]\n", "[contacts.mortar_mortar]\nlaw = \"" + law + "\"\n");
  if (law == "renamed") text = with(text, "f_t = ", "u_mark = \"1 um\"\nf_t = ");
  text += "[materials.mortar.creep]\nstrain = { table = [[\"20 degC\", 0], [\"820 degC\", 0.4]] }\n";
  pyroclast::Setup setup = read_setup(Deck::parse(text, "deck.toml"), ".", {}, sources);
  auto simulation = make_simulation(setup);
  Run run(*simulation, std::move(setup.stages));
  run.run();
  EXPECT_EQ(run.outcome(), Outcome::completed);
  EXPECT_GT(run.history().last("dissipated_creep_J").value(), 0.0);
  EXPECT_LT(std::abs(run.history().last("energy_error_J").value()),
            1e-3 * run.history().last("energy_loading_J").value());
  return simulation;
}

// Promise: zones creep beside the contacts of a law from a shared object as beside those of the program, to
// the bit.
TEST(Plugin, ALoadedLawStandsBesideAPhaseThatCreeps) {
  LawSources sources;
  sources.folders = {LAWS};
  const auto own = creeping_body("renamed", sources), built_in = creeping_body("cohesive", sources);
  EXPECT_STREQ(own->materials().contacts[2].law->name, "renamed");
  EXPECT_EQ(in_plane::mechanics(own->motion()).read().displacements(),
            in_plane::mechanics(built_in->motion()).read().displacements());
  double crept = 0.0;
  for (int z = 0; z < own->model().zone_count(); ++z) {
    EXPECT_EQ(own->motion().read().creep_strain(z), built_in->motion().read().creep_strain(z));
    crept = std::min(crept, own->motion().read().creep_strain(z)[1]);
  }
  EXPECT_LT(crept, -1e-5);
}

TEST(Plugin, ALawForPlaneBodiesIsRefusedInSpace) {
  LawSources sources;
  sources.folders = {LAWS};
  EXPECT_STREQ(find_law("small", "", sources, true).name, "small");
  sources.compiler.dimension = 3;
  EXPECT_TRUE(
      says(message([&] { find_law("small", "", sources, true); }), {"made for bodies in 2D, not in 3D"}));

  const auto model = bodies::five_tetrahedra();
  const LawTable& law = open_law(law_file("small")).table;
  BodyProperties properties;
  properties.zones.assign(model.zones.size(), zone_properties<3>(30e9, 0.2));
  properties.contacts.add({law, {1e12}, {}});
  properties.of_contact.assign(static_cast<std::size_t>(model.contact_count()), 0);
  MechanicsParameters parameters;
  parameters.safety = 0.5;
  EXPECT_TRUE(says(message([&] { Mechanics<3>(model, {2300.0}, properties, parameters); }),
                   {"\"small\" is made for bodies in 2D, not in 3D"}));
}

TEST(Plugin, ANameIsSearchedInTheProgramBesideTheDeckAndInTheFolders) {
  LawSources sources;
  EXPECT_EQ(&find_law("cohesive", "", sources), &table_of<Cohesive>());
  EXPECT_STREQ(find_law("renamed", LAWS, sources, true).name, "renamed");
  EXPECT_STREQ(find_law("renamed.so", LAWS, sources, true).name, "renamed");
  EXPECT_TRUE(says(message([&] { find_law("absent", "some/deck", sources); }),
                   {"\"absent\"", "cohesive", "absent.so in some/deck"}));
  sources.folders = {"here", LAWS};
  EXPECT_STREQ(find_law("renamed", "some/deck", sources).name, "renamed");
  EXPECT_TRUE(says(message([&] { find_law("absent.so", "some/deck", sources); }), {"some/deck/absent.so"}));
  EXPECT_TRUE(says(message([&] { find_law("absent.hpp", "some/deck", sources); }), {"some/deck/absent.hpp"}));
}

TEST(Plugin, TheEnvironmentNamesFoldersAndForbidsCompiling) {
  setenv("PYROCLAST_LAW_PATH", "/one::/two", 1);
  setenv("PYROCLAST_NO_COMPILE", "1", 1);
  setenv("PYROCLAST_CACHE", "/three", 1);
  const auto sources = LawSources::of_environment();
  for (const char* name : {"PYROCLAST_LAW_PATH", "PYROCLAST_NO_COMPILE", "PYROCLAST_CACHE"}) unsetenv(name);
  EXPECT_EQ(sources.folders, (std::vector<fs::path>{"/one", "/two"}));
  EXPECT_FALSE(sources.may_compile);
  EXPECT_EQ(sources.compiler.cache, "/three/laws");
  EXPECT_TRUE(LawSources::of_environment().may_compile);
}

/// A header that is compiled here, in a folder of the test's own.
class LawInAHeader : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = own_folder() / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    sources_.compiler.cache = folder_ / "cache";
    sources_.permission.policy = CodePolicy::always;
    sources_.compiler.instructions = InstructionSet::portable;
    sources_.compiler.tell = [this](const std::string& command) { commands_.push_back(command); };
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string small() {
    std::ifstream stream(fs::path(HEADERS) / "small.hpp");
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  /// Returns the small law with a change to its text.
  static std::string small_with(const std::string& before, const std::string& after) {
    std::string text = small();
    const auto at = text.find(before);
    EXPECT_NE(at, std::string::npos) << before;
    return text.replace(at, before.size(), after);
  }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  std::string refusal_of(const std::string& stated) {
    return message([&] { find_law(stated, folder_, sources_); });
  }

  fs::path folder_;
  LawSources sources_;
  std::vector<std::string> commands_;
};

TEST_F(LawInAHeader, AHeaderIsCompiledOnceForEachText) {
  write("mine.hpp", small());
  const LawTable& law = find_law("mine.hpp", folder_, sources_);
  EXPECT_STREQ(law.name, "small");
  ASSERT_EQ(commands_.size(), 1U);
  EXPECT_TRUE(says(commands_[0], {"-ffp-contract=off", "-O3"}));
  EXPECT_EQ(commands_[0].find("march=native"), std::string::npos);
  EXPECT_EQ(opened_laws().back()->headers.front(), fs::canonical(folder_ / "mine.hpp"));
  struct stat cache {};
  ASSERT_EQ(stat(sources_.compiler.cache.c_str(), &cache), 0);
  EXPECT_EQ(cache.st_mode & 0777, 0700U);

  const auto compile = [&](const fs::path& header = "mine.hpp") {
    return compile_law(preprocess_law(folder_ / header, sources_.compiler), "small::Law", sources_.compiler);
  };
  std::vector<fs::path> found(2);
  std::thread other([&] { found[0] = compile(); });
  found[1] = compile();
  other.join();
  EXPECT_EQ(found[0], found[1]);
  EXPECT_EQ(commands_.size(), 1U) << "the same text is compiled once";
  // a run that goes on has a copy of the header elsewhere
  fs::create_directories(folder_ / "inputs");
  write("inputs/of_a_run.hpp", small());
  EXPECT_EQ(compile("inputs/of_a_run.hpp"), found[0]);
  EXPECT_EQ(commands_.size(), 1U) << "wherever it lies";

  // a body moves with it
  const auto model = bodies::column(3, 0.01);
  BodyProperties properties;
  properties.zones.assign(model.zones.size(), zone_properties<2>(30e9, 0.2));
  properties.contacts.add({law, {1e12}, {}});
  properties.of_contact.assign(static_cast<std::size_t>(model.contact_count()), 0);
  MechanicsParameters parameters;
  parameters.safety = 0.5;
  parameters.instructions = InstructionSet::portable;
  Mechanics<2> body(model, {2300.0}, properties, parameters);
  body.constraints().prescribe_velocity(0, 1, 0.01);
  body.advance(10);
  EXPECT_NE(body.read().contact(0).normal_traction, 0.0);
  if (usable_instruction_sets().size() > 1) {
    parameters.instructions = usable_instruction_sets().back();
    EXPECT_TRUE(says(
        message([&] { Mechanics<2>(model, {2300.0}, properties, parameters); }),
        {"\"small\" is not compiled for the instruction set", "but for portable: --instructions portable"}));
  }
}

// Promise: a law in a header is compiled for the dimension of the deck that names it.
TEST_F(LawInAHeader, ABodyInSpaceHasItsLawFromAHeaderToo) {
  fs::copy(fs::path(HEADERS) / "renamed.hpp", folder_ / "mine.hpp");
  sources_.compiler.instructions = best_instruction_set();
  std::string text = with(deck(kSettle), "height = \"120 mm\"", "height = \"120 mm\"\ndepth = \"60 mm\"");
  text = with(text, "[contacts.mortar_mortar]\n",
              "[contacts.mortar_mortar]\nlaw = \"mine.hpp\"\nu_mark = \"1 um\"\n");
  pyroclast::Setup setup = read_setup(Deck::parse(text, "deck.toml"), folder_, {}, sources_);
  auto simulation = make_simulation(setup);
  EXPECT_EQ(simulation->model().dimension(), 3);
  pyroclast::Run run(*simulation, std::move(setup.stages));
  run.run();
  EXPECT_EQ(run.outcome(), Outcome::completed);
  EXPECT_STREQ(simulation->materials().contacts[2].law->name, "renamed");
}

TEST_F(LawInAHeader, WhatThePollThrowsEndsTheCompilerAndLeavesNothingInTheCache) {
  write("mine.hpp", small() + "// another text\n" + "namespace small { inline int more() { return 1; } }\n");
  LawCompiler compiler = sources_.compiler;
  bool compiles = false;
  compiler.tell = [&](const std::string&) { compiles = true; };
  compiler.poll = [&] {
    if (compiles) throw std::runtime_error("interrupted");
  };
  const LawText law = preprocess_law(folder_ / "mine.hpp", compiler);
  EXPECT_THROW(compile_law(law, "small::Law", compiler), std::runtime_error);
  EXPECT_TRUE(compiles);
  for (const auto& file : fs::directory_iterator(compiler.cache)) EXPECT_NE(file.path().extension(), ".so");
}

TEST_F(LawInAHeader, WhatDoesNotCompileIsRefusedWithTheLineOfTheLaw) {
  const std::string text = small_with("= c.stiffness * opening;", "= c.stifness * opening;");
  const auto number =
      std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find("stifness")), '\n') + 1;
  write("wrong.hpp", text);
  EXPECT_TRUE(says(refusal_of("wrong.hpp"), {fmt::format("wrong.hpp:{}:", number), "error:", "stifness",
                                             "does not compile as the contact law small::Law"}));
}

// Promise: where lanes lack a function, the message names those that they have, which compile.
TEST_F(LawInAHeader, WhatLanesLackIsToldWithWhatTheyHave) {
  const auto with = [](const std::string& value) {
    return "#include <algorithm>\n#include <pyroclast/base/exp.hpp>\n" +
           small_with("= c.stiffness * opening;",
                      "= c.stiffness * opening; using std::sqrt; using std::abs; "
                      "using namespace pyroclast;\n r.stored = " +
                          value + ";");
  };
  for (const char* lacking : {"std::tanh(opening)", "opening > 0.0 ? opening : Real(0.0)"}) {
    write("lacks.hpp", with(lacking));
    EXPECT_TRUE(says(refusal_of("lacks.hpp"),
                     {"lacks.hpp:",
                      "Lanes have + - * / < <= > >= & | !, select(condition, yes, no), smaller, "
                      "larger, abs, sqrt, signed_like, and exp of <pyroclast/base/exp.hpp>"}))
        << lacking;
  }
  write("has.hpp", with("select((opening < 1.0) & (opening <= 1.0) | !(opening > 1.0) & (opening >= 1.0), "
                        "smaller(opening, larger(abs(opening), sqrt(opening * opening / Real(2.0)))), "
                        "signed_like(pyroclast::exp(opening - 1.0), opening) + 1.0)"));
  EXPECT_NO_THROW(
      compile_law(preprocess_law(folder_ / "has.hpp", sources_.compiler), "small::Law", sources_.compiler));
}

// Promise: a law that lacks a part is told all parts of a law.
TEST_F(LawInAHeader, WhatALawLacksIsToldWithAllThatALawHas) {
  for (const char* part : {"check(", "each_choice("}) {
    write("lacks.hpp", small_with(part, fmt::format("not_{}", part)));
    EXPECT_TRUE(says(refusal_of("lacks.hpp"),
                     {"A law has name, meaning, Properties, Constants, Internals, Losses, derive, check, "
                      "stiffness and update: <pyroclast/laws/law.hpp>"}))
        << part;
  }
}

TEST_F(LawInAHeader, ACompilerThatIsTooOldIsNamed) {
  write("mine.hpp", small());
  write("old",
        "#!/bin/sh\necho 'c++ (Debian 10.2.1-6) 10.2.1 20210110'\n"
        "echo 'Copyright (C) 2020 Free Software Foundation, Inc.'\n");
  fs::permissions(folder_ / "old", fs::perms::owner_all);
  sources_.compiler.program = folder_ / "old";
  EXPECT_TRUE(says(refusal_of("mine.hpp"), {"(Debian 10.2.1-6) 10.2.1", "too old", "GCC 11 or later"}));
}

// Promise: macros may grow without end, so the preprocessor has a minute of a processor and 256 MiB for its
// text.
TEST_F(LawInAHeader, ThePreprocessorHasItsLimits) {
  write("mine.hpp", small());
  write("limits",
        "#!/bin/sh\ncase \"$*\" in --version) echo 'of the test 1.0'; exit;; esac\n"
        "awk '/^Max (cpu time|file size)/ { print $(NF - 2), $(NF - 1) }' /proc/self/limits\nexit 1\n");
  fs::permissions(folder_ / "limits", fs::perms::owner_all);
  sources_.compiler.program = folder_ / "limits";
  expect_in("the preprocessor refuses this contact law", refusal_of("mine.hpp"));
  std::ifstream said(sources_.compiler.cache / "messages.txt");
  const std::string limits{std::istreambuf_iterator<char>(said), {}};
  EXPECT_EQ(limits, fmt::format("60 60\n{0} {0}\n", 256 * 1024 * 1024));
}

TEST_F(LawInAHeader, CompilingCanBeForbidden) {
  write("mine.hpp", small());
  sources_.may_compile = false;
  EXPECT_TRUE(says(refusal_of("mine.hpp"), {"--no-compile", "pyroclast_add_law"}));
  EXPECT_FALSE(fs::exists(sources_.compiler.cache));
}

TEST_F(LawInAHeader, ACacheThatOthersMayWriteIsNotTrusted) {
  write("mine.hpp", small());
  fs::create_directories(sources_.compiler.cache);
  fs::permissions(sources_.compiler.cache, fs::perms::group_write, fs::perm_options::add);
  EXPECT_TRUE(says(refusal_of("mine.hpp"), {"cache", "not trusted", "0700"}));
  fs::remove(sources_.compiler.cache);
  fs::create_directories(folder_ / "elsewhere");
  fs::create_directory_symlink(folder_ / "elsewhere", sources_.compiler.cache);
  EXPECT_TRUE(says(refusal_of("mine.hpp"), {"is not a folder"}));
}

TEST_F(LawInAHeader, ACompilerThatIsNotThereIsNamed) {
  write("mine.hpp", small());
  sources_.compiler.program = "no-such-compiler";
  EXPECT_TRUE(says(refusal_of("mine.hpp"), {"no-such-compiler"}));
}

/// Code beside a deck of somebody else.
class CodeOfADeck : public LawInAHeader {
 protected:
  void SetUp() override {
    LawInAHeader::SetUp();
    sources_.permission = {CodePolicy::ask, false, folder_ / "config" / "allowed-code"};
    write("mine.hpp", "#include \"part.hpp\"\n" + small());
    write("part.hpp", "// nothing\n");
  }
  bool is_refused(const std::string& stated, bool named = false) {
    try {
      find_law(stated, folder_, sources_, named);
    } catch (const CodeNotAllowed& error) {
      EXPECT_EQ(error.code().what, folder_ / "mine.hpp");
      return true;
    }
    return false;
  }
};

TEST_F(CodeOfADeck, RunsAfterTheUsersWordAndUntilItChanges) {
  EXPECT_TRUE(is_refused("mine.hpp"));
  EXPECT_TRUE(commands_.empty()) << "nothing is compiled before";
  sources_.permission.allow = true;
  EXPECT_FALSE(is_refused("mine.hpp"));
  sources_.permission.allow = false;
  EXPECT_FALSE(is_refused("mine.hpp"));
  EXPECT_FALSE(is_refused("mine.hpp:small::Law"));
  write("part.hpp", "// something\n");
  EXPECT_TRUE(is_refused("mine.hpp")) << "a file that it includes has changed";
  EXPECT_FALSE(is_refused("mine.hpp", true)) << "the user names it";
  EXPECT_FALSE(is_refused("mine.hpp")) << "and did so";
  sources_.permission.policy = CodePolicy::never;
  EXPECT_TRUE(is_refused("mine.hpp"));
  EXPECT_FALSE(is_refused("mine.hpp", true));
  write("part.hpp", "// another thing\n");
  sources_.permission.policy = CodePolicy::ask;
  sources_.folders = {folder_};
  EXPECT_FALSE(is_refused("mine.hpp")) << "it lies in a folder that the user names";
}

TEST_F(CodeOfADeck, AListThatOthersMayWriteIsNotTrusted) {
  sources_.permission.allow = true;
  EXPECT_FALSE(is_refused("mine.hpp"));
  fs::permissions(sources_.permission.list, fs::perms::others_write, fs::perm_options::add);
  EXPECT_TRUE(says(refusal_of("mine.hpp"), {"allowed-code", "not trusted", "chmod 0600"}));
  fs::permissions(sources_.permission.list, fs::perms::others_write, fs::perm_options::remove);
  EXPECT_FALSE(is_refused("mine.hpp"));
  fs::permissions(folder_ / "config", fs::perms::group_write, fs::perm_options::add);
  EXPECT_TRUE(says(refusal_of("mine.hpp"), {"config: ", "not trusted", "chmod 0700"}));
}

// Promise: a file that the compiler takes into the law is in the hash, by whatever words it is included.
TEST_F(CodeOfADeck, AFileIsInTheHashHoweverItIsIncluded) {
  const std::string here = fs::canonical(folder_).string();
  fs::create_directories(folder_ / "sub dir");
  fs::create_symlink("../part.hpp", folder_ / "sub dir" / "link$#.hpp");
  const auto hash = [&] {
    const LawText law = preprocess_law(folder_ / "mine.hpp", sources_.compiler);
    EXPECT_EQ(law.files.size(), 2U);
    return law.hash;
  };
  for (const std::string& line : {
           std::string("\xEF\xBB\xBF#include \"part.hpp\"\n"),
           std::string("#inc\\ \nlude \"part.hpp\"\n"),
           std::string("constexpr int kA = 1'0 + '/*';\n#include \"part.hpp\"\nconstexpr int kB = '*/';\n"),
           std::string("#define PART \"part.hpp\"\n#include PART\n"),
           std::string("#if __has_include(\"part.hpp\")\n%:include \"part.hpp\"\n#endif\n"),
           std::string("const char* s = R\"(/*)\";\n/*\\\n*/ # /**/ include \"part.hpp\"\n"),
           std::string("#import \"sub dir/link$#.hpp\"\n"),
           fmt::format("#include <{}/part.hpp>\n", here),
           std::string("#line 1 \"/usr/include/stdio.h\"\n#include \"part.hpp\"\n"),
       }) {
    write("part.hpp", "#pragma once\n#pragma GCC system_header\n");
    write("mine.hpp", line + small());
    const std::string before = hash();
    EXPECT_EQ(hash(), before) << line;
    write("part.hpp", "#pragma once\n#pragma GCC system_header\ninline int more() { return 1; }\n");
    EXPECT_NE(hash(), before) << line;
  }
}

// Promise: a folder that the environment names to the compiler is the user's, its files are in the hash.
TEST_F(CodeOfADeck, AFileThatTheEnvironmentBringsIsInTheHash) {
  fs::create_directories(folder_ / "other");
  write("other/far.hpp", "inline int far() { return 1; }\n");
  write("mine.hpp", "#include <far.hpp>\n" + small());
  setenv("CPLUS_INCLUDE_PATH", (folder_ / "other").c_str(), 1);
  const LawText before = preprocess_law(folder_ / "mine.hpp", sources_.compiler);
  write("other/far.hpp", "inline int far() { return 2; }\n");
  const LawText after = preprocess_law(folder_ / "mine.hpp", sources_.compiler);
  unsetenv("CPLUS_INCLUDE_PATH");
  EXPECT_EQ(before.files.back(), folder_ / "other" / "far.hpp");
  EXPECT_NE(before.hash, after.hash);
}

// Promise: what a header asks of its surroundings is in the hash by what it makes of the law.
TEST_F(CodeOfADeck, AFileThatIsAskedForOnlyIsInTheHashByItsEffect) {
  write("mine.hpp", "#if __has_include(\"flag\")\ninline int more() { return 1; }\n#endif\n" + small());
  const std::string before = preprocess_law(folder_ / "mine.hpp", sources_.compiler).hash;
  write("flag", "");
  EXPECT_NE(preprocess_law(folder_ / "mine.hpp", sources_.compiler).hash, before);
}

// Promise: the hash holds in another folder and under another name, for a law that names its own file too.
TEST_F(CodeOfADeck, TheHashHoldsWhereverTheFilesLie) {
  const std::string text =
      "#include \"part.hpp\"\ninline const char* file() { return __FILE__; }\n" + small();
  write("mine.hpp", text);
  fs::create_directories(folder_ / "a dir");
  write("a dir/mine.hpp", text);
  write("a dir/part.hpp", "// nothing\n");
  const LawText here = preprocess_law(folder_ / "mine.hpp", sources_.compiler),
                there = preprocess_law(folder_ / "a dir" / "mine.hpp", sources_.compiler);
  EXPECT_EQ(here.hash, there.hash);
  EXPECT_EQ(here.normalised, there.normalised);
}

TEST_F(CodeOfADeck, WhatWouldBeReadAfterTheHashIsRefused) {
  write("mine.hpp", "#define HASH #\nHASH include \"part.hpp\"\n" + small());
  EXPECT_TRUE(says(refusal_of("mine.hpp"), {"mine.hpp", "# include \"part.hpp\"", "stays in the text"}));
  write("mine.hpp", "inline const char* when() { return __TIME__; }\n" + small());
  EXPECT_TRUE(says(refusal_of("mine.hpp"), {"mine.hpp:1:", "date-time"}));
  sources_.permission.policy = CodePolicy::always;
  write("mine.hpp", "#pragma GCC pch_preprocess \"part.gch\"\n" + small());
  EXPECT_TRUE(says(refusal_of("mine.hpp"), {"mine.hpp:1:", "pch_preprocess"}));
  write("mine.hpp", small() + fmt::format("asm(\".section .comment\\n.inc\" \"bin \\\"{}\\\"\\n.text\");\n",
                                          (folder_ / "part.hpp").string()));
  EXPECT_TRUE(says(refusal_of("mine.hpp"), {"the assembler reads", "part.hpp", ".incbin"}));
  for (const auto& file : fs::directory_iterator(sources_.compiler.cache))
    EXPECT_NE(file.path().extension(), ".so");
}

TEST(Plugin, ARuleOfMakeNamesFiles) {
  EXPECT_EQ(files_of_rule("law: /a/b.hpp \\\n /c\\ d/e$$\\#.hpp\n\n/x.hpp:\n"),
            (std::vector<fs::path>{"/a/b.hpp", "/c d/e$#.hpp"}));
  EXPECT_TRUE(files_of_rule("").empty());
}

TEST_F(CodeOfADeck, ATypeIsAName) {
  for (const char* const type :
       {"small::Law, int>(); system(\"x\")", "small::Law\n#include \"part.hpp\"", "::", "1a", "a::", "a b"})
    EXPECT_TRUE(says(refusal_of(fmt::format("mine.hpp:{}", type)), {"is a name such as mine::Law"})) << type;
}

TEST(Plugin, TheEnvironmentSaysWhichCodeRuns) {
  const auto policy = [](const char* word) {
    setenv("PYROCLAST_CODE", word, 1);
    setenv("XDG_CONFIG_HOME", "/four", 1);
    const auto permission = CodePermission::of_environment();
    unsetenv("PYROCLAST_CODE");
    unsetenv("XDG_CONFIG_HOME");
    EXPECT_EQ(permission.list, "/four/pyroclast/allowed-code");
    return permission.policy;
  };
  EXPECT_EQ(policy(""), CodePolicy::ask);
  EXPECT_EQ(policy("ask"), CodePolicy::ask);
  EXPECT_EQ(policy("never"), CodePolicy::never);
  EXPECT_EQ(policy("always"), CodePolicy::always);
  EXPECT_TRUE(says(message([&] { policy("perhaps"); }), {"perhaps", "never", "ask", "always"}));
  unsetenv("PYROCLAST_CODE");
  unsetenv("XDG_CONFIG_HOME");
}

TEST(Plugin, TheTypeOfAHeaderIsTheStructWithAName) {
  EXPECT_EQ(law_type("a.hpp", R"(namespace a::b { struct Helper { const char* name = "x"; };
struct Base {}; struct Law final : Base { static constexpr const char* name = "struct {"; }; })"),
            "a::b::Law");
  EXPECT_EQ(
      law_type("b.hpp", "struct Law { void f() { for (;;) {} } static constexpr auto name = \"b\"; };\n"),
      "Law");
  // a struct that is named alone opens no brace that comes after it
  EXPECT_EQ(
      law_type("d.hpp",
               "struct Options;\nextern \"C++\" { struct Law { static constexpr auto name = \"d\"; }; }\n"
               "inline void show(const struct Options&) { static constexpr auto name = \"no law\"; }\n"),
      "Law");
  // quotes and braces in literals of characters, behind digits and in raw strings open nothing
  EXPECT_EQ(law_type("e.hpp",
                     "constexpr char kQuote = '\"', kBrace = '{', kEscaped = '\\'';\n"
                     "constexpr int kMany = 1'000'000;\nconstexpr auto kRaw = R\"x(struct No {\")x\";\n"
                     "struct Law { static constexpr auto name = \"e\"; };\n"),
            "Law");
  const auto refused = [](const std::string& text) { return message([&] { law_type("c.hpp", text); }); };
  EXPECT_TRUE(
      says(refused("namespace a { struct B { static constexpr auto name = 1; }; struct C { static constexpr "
                   "auto name = 2; }; }"),
           {"2 contact laws: a::B, a::C", "c.hpp:a::B"}));
  EXPECT_TRUE(says(refused("struct D { int name = 1; };"), {"c.hpp", "holds no contact law"}));
}

}  // namespace
}  // namespace pyroclast
