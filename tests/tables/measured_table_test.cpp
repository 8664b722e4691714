#include "pyroclast/tables/measured_table.hpp"

#include <gtest/gtest.h>

#include "layouts.hpp"
#include "messages.hpp"

namespace pyroclast {
namespace {

using layouts::Record;

const Record kFurnace{{0.0, 20.0}, {30.0, 41.5}, {90.0, 185.25}, {1800.0, 842.125}, {7200.0, 1049.0}};

void expect_same(const Record& read, const Record& record, const std::string& text) {
  ASSERT_EQ(read.size(), record.size()) << text;
  for (std::size_t i = 0; i < record.size(); ++i) {
    EXPECT_EQ(read[i].first, record[i].first) << "row " << i << " of\n" << text;
    EXPECT_EQ(read[i].second, record[i].second) << "row " << i << " of\n" << text;
  }
}

// Promise: one record reads to the same numbers, to the bit, however it is written.
TEST(MeasuredTable, ThirtyLayoutsOfOneRecordAreTheSame) {
  for (const layouts::Layout& layout : layouts::all()) {
    const std::string text = layouts::written(layout, kFurnace);
    Record read;
    ASSERT_NO_THROW(read = layouts::read(text, layouts::choice_of(layout))) << text;
    expect_same(read, kFurnace, text);
  }
}

// Promise: the same for whatever of these is put together, where a reader can tell a comma from a comma.
TEST(MeasuredTable, AllCombinationsAreTheSame) {
  using namespace layouts;
  int count = 0;
  for (const std::string_view delimiter : {",", ";", "\t", " "}) {
    for (const char decimal : {'.', ','}) {
      for (const Units units : {Units::brackets, Units::parentheses, Units::slash, Units::row_below,
                                Units::row_above, Units::suffix}) {
        for (const Time time : {Time::seconds, Time::minutes, Time::clock, Time::minutes_seconds}) {
          for (const Names names : {Names::plain, Names::quoted, Names::none}) {
            for (const std::string_view begin : {std::string_view(""), kMark}) {
              for (const bool has_index : {false, true}) {
                if (delimiter == " " && has_index) continue;  // a name that is missing does not show
                const bool quotes_cells = delimiter == "," && decimal == ',';
                const Layout layout{delimiter, decimal,   units, time,  names, begin,
                                    "\n",      has_index, false, false, false, quotes_cells};
                if (names != Names::none && units == Units::suffix && time >= Time::clock) continue;
                const std::string text = written(layout, kFurnace);
                Record read;
                ASSERT_NO_THROW(read = layouts::read(text, choice_of(layout))) << text;
                expect_same(read, kFurnace, text);
                ++count;
              }
            }
          }
        }
      }
    }
  }
  EXPECT_GT(count, 1500);
}

std::string refusal(std::string_view text, const ColumnChoice& choice = {"furnace.csv", {}, {}}) {
  return message([&] { layouts::read(text, choice); });
}

TEST(MeasuredTable, ReadsWhatElseIsWritten) {
  const Record two{{0.0, 20.0}, {1800.0, 800.0}};
  for (const std::string text : {
           "time [min],temperature [degC]\n0,20\n30,800\n",
           "time [min],temperature [°C]\n0,20\n30,800\n",
           "time [min], temperature [C]\n0, 20\n30, 800\n",
           "time [min]; temperature [K]\n0; 293,15\n30; 1073,15\n",
           "Time,TC1\nmin,C\n0,20\n30,800\n",
           "min,C\nTime,TC1\n0,20\n30,800\n",
           "Zeit;TC 1, Mitte\n[min];[degC]\n0;20\n30;800\n",
           ",time [min],temperature [degC]\n0,0,20\n1,30,800\n",
           "No.\ttime [min]\ttemperature [degC]\n1\t0\t20\n2\t30\t800\n",
           "\ttime [min]\ttemperature [degC]\n0\t0\t20\n1\t30\t800\n",
           "time [min],temperature [degC],\n0,20,\n30,800,\n",
           "time [min],temperature [degC],,\n0,20,,\n,,,\n30,800,,\n,,,\n",
           "time [min]   gas temperature [degC]\n  0          20\n  30         800\n",
           "time [min]\t\ttemperature [degC]\n0\t\t20\n30\t\t800\n",
           "time [min],\ttemperature [degC]\n0,\t20\n30,\t800\n",
           "time / min   T / °C\n0  20\n30  800\n",
           "t/min;T/K\n0;293.15\n30;1073.15\n",
           "time [h:min:s],temperature [degC]\n0:00:00.0,20\n0:30:00,800\n",
           "time,temperature [degC]\n00:00:00,20\n00:30:00,800\n",
           "time,temperature [degC]\n00:00,20\n30:00,800\n0:59:00,900\n",
           "time [hh:mm],temperature [degC]\n00:00,20\n00:30,800\n",
           "time [s],temperature [degC]\n0,20\n\"1,800.0\",800\n",
           "time [s];temperature [degC]\n0;20,0\n1.800,0;800\n",
           "time [s];temperature [degC]\n0;20,0\n1,8e3;8E+2\n",
           "time_min,gas_degC\n0,20\n30,800\n",
           "! a\n% b\n// c\n# d\n\ntime [min],temperature [degC]\n0,+20\n# e\n+30,+800\n",
           "SEP=;\ntime [min];temperature [degC]\n0;20\n30;800",
           "\"time [min]\";\"the \"\"gas\"\" [degC]\"\n\"0\";\"20\"\n\"30\";\"800\"\n",
           "time [min] , temperature [degC]\r0 , 20\r30 , 800\r",
       }) {
    Record read;
    ASSERT_NO_THROW(read = layouts::read(text)) << text;
    if (read.size() == 3) read.pop_back();
    expect_same(read, two, text);
  }
}

TEST(MeasuredTable, ReadsNegativeNumbers) {
  const std::string text =
      "time [s];temperature [degC]\n0;-20,5\n1;\xE2\x88\x92"
      "3\n";
  expect_same(layouts::read(text), {{0.0, -20.5}, {1.0, -3.0}}, text);
}

TEST(MeasuredTable, TakesColumnsByNameOrNumber) {
  const std::string text = "scan,time [min],TC1 [degC],TC2,state\n7,0,20,21,on\n9,30,800,805,off\n";
  const Record tc2{{0.0, 21.0}, {1800.0, 805.0}};
  expect_same(layouts::read(text, {"f.csv", {{"time"}, {"TC2"}}, {"", "degC"}}), tc2, text);
  expect_same(layouts::read(text, {"f.csv", {{"", 2}, {"", 4}}, {"min", "C"}}), tc2, text);
  const std::string bare = "0 20 21\n30 800 805\n";
  expect_same(layouts::read(bare, {"f.csv", {{"", 1}, {"", 3}}, {"min", "degC"}}), tc2, bare);
}

TEST(MeasuredTable, RefusesOtherColumnsThanAsked) {
  const std::string text = "time [min],TC1 [degC],TC2 [degC]\n0,20,21\n30,800,805\n";
  const std::string all = refusal(text);
  expect_in("furnace.csv:1: has 3 columns, of which 2 are needed (time, temperature)", all);
  expect_in("1 \"time\" [min], 2 \"TC1\" [degC], 3 \"TC2\" [degC]", all);
  expect_in("write { csv = \"furnace.csv\", columns = [\"time\", \"TC1\"] }", all);
  expect_in("{ csv = \"furnace.csv\", columns = [1, 2], units = [\"s\", \"degC\"] }",
            refusal("0 20 21\n30 800 805\n"));
  const std::string misspelt = refusal(text, {"furnace.csv", {{"time"}, {"TC11"}}, {}});
  expect_in("has no column \"TC11\"; did you mean \"TC1\"?; it has 1 \"time\"", misspelt);
  expect_in("has no column 4", refusal(text, {"furnace.csv", {{"", 1}, {"", 4}}, {}}));
  expect_in("is chosen twice", refusal(text, {"furnace.csv", {{"TC1"}, {"", 2}}, {}}));
  expect_in("more than one column \"a\"; write one of their numbers, 2 or 3",
            refusal("t [s],a [degC],a [degC]\n0,1,2\n1,2,3\n", {"furnace.csv", {{"t"}, {"a"}}, {}}));
  expect_in("has 1 column (delimiter: none), but 2 are needed", refusal("time [s]\n1\n2\n"));
  // counting times are no index before columns of which none is a time
  expect_in("has 3 columns", refusal("time,TC1 [degC],TC2 [degC]\n0,20,21\n1,30,31\n"));
}

TEST(MeasuredTable, RefusesColumnsWithoutUnit) {
  const std::string text = refusal("time [min],gas\n0,20\n30,800\n");
  expect_in(
      "furnace.csv:1: column \"gas\" has no unit; write \"gas [degC]\" above it, or { csv = \"furnace.csv\", "
      "columns = [\"time\", \"gas\"], units = [\"min\", \"degC\"] }",
      text);
  expect_in("column 1 has no unit; write \"time [s]\" above it", refusal("0,20\n30,800\n"));
  expect_in("unknown unit \"foo\"", refusal("time [foo],gas [degC]\n0,20\n30,800\n"));
  expect_in("wrong dimension", refusal("time [min],gas [m]\n0,20\n30,800\n"));
  expect_in("is in \"min\" by the file and in \"s\" by the deck",
            refusal("time [min],gas [degC]\n0,20\n30,800\n", {"furnace.csv", {}, {"s", ""}}));
  expect_in("has the unit \"s\" behind its name and \"min\" in the row of units",
            refusal("time [s],gas\nmin,degC\n0,20\n1,30\n"));
}

TEST(MeasuredTable, ShowsBothReadingsOfACommaOfThreeDigits) {
  const std::string text = refusal("time [s];T [degC]\n0;20\n60;1,234\n");
  expect_in("furnace.csv:3: \"1,234\" may be 1.234 (decimal comma) or 1234 (comma between thousands)", text);
  expect_in("such as by `sed", text);
  const std::string quoted = refusal("time [s],T [degC]\n0,20\n600,220\n\"1,200\",420\n");
  expect_in("furnace.csv:4: \"1,200\" may be 1.200 (decimal comma) or 1200", quoted);
  expect_out("sed", quoted);  // it would turn the commas between the columns too
  const std::string both = refusal("time [s];T [degC]\n0;20,5\n60;21.5\n");
  expect_in("furnace.csv:3: \"21.5\" in line 3 has a point and \"20,5\" in line 2 a comma", both);
  expect_in("each of which may be the decimal sign", refusal("time [s];T [degC]\n0;20,5\n60;1.234\n"));
  expect_in("each of which may be the decimal sign", refusal("time [s];T [degC]\n0;20.5\n60;1,234\n"));
  const auto one = [](std::string_view lines) {
    return message([&] { MeasuredTable::parse(lines, "path.csv", 1); });
  };
  expect_in(
      "path.csv:2: \"2,345\" may be one number with a decimal comma or two numbers with a comma between "
      "them; "
      "write \"2.345\" or \"2; 345\"",
      one("1,234\n2,345\n"));
}

TEST(MeasuredTable, TellsADecimalCommaFromADelimiter) {
  expect_in(
      "furnace.csv:2: \"0,0,20,5\" has 4 cells, line 1 has 2 (delimiter: \",\"); a comma cannot be the "
      "delimiter "
      "and the decimal sign",
      refusal("time [s],T [degC]\n0,0,20,5\n60,0,30,5\n"));
  EXPECT_EQ(MeasuredTable::parse("u_n [um]\n0,5\n1,234\n", "path.csv", 1).columns().size(), 1u);
  EXPECT_EQ(MeasuredTable::parse("u_n [um],u_s [um]\n0,5\n1,234\n", "path.csv", 1).columns().size(), 2u);
}

TEST(MeasuredTable, ShowsBothReadingsOfATimeOfTwoParts) {
  expect_in(
      "furnace.csv:2: \"00:00\" in column \"time\" may be minutes and seconds or hours and minutes; write "
      "\"time "
      "[mm:ss]\" or \"time [hh:mm]\"",
      refusal("time,T [degC]\n00:00,20\n12:30,800\n"));
  expect_in("furnace.csv:2: \"00:00:00\" in column \"time\" is a time, but the column is in \"min\"",
            refusal("time [min],T [degC]\n00:00:00,20\n00:12:30,800\n"));
}

TEST(MeasuredTable, RefusesDatesWithoutATime) {
  expect_in("furnace.csv:2: \"01/02/2024\" in column \"time\" is a date without a time of the day",
            refusal("time [s],T [degC]\n01/02/2024,20\n02/02/2024,800\n"));
  expect_in("furnace.csv:3: \"2024-02-02T25:00\" in column \"time\" is a date, and no time of the day",
            refusal("time,T [degC]\n2024-02-02T23:00,20\n2024-02-02T25:00,800\n"));
}

/// Record whose times are these, with temperatures that say their places.
std::string record_of(const std::string& header, const std::vector<std::string>& times) {
  std::string text = header + ";T [degC]\n";
  for (std::size_t i = 0; i < times.size(); ++i) text += fmt::format("{};{}\n", times[i], 20 + i);
  return text;
}

// Promise: times that do not ascend are told with their lines, and with a remedy that keeps the record whole.
TEST(MeasuredTable, NamesTheLinesOfTimesThatDoNotAscend) {
  struct Case {
    std::string header;
    std::vector<std::string> times;
    std::string told;
  };
  const Case cases[] = {
      {"time [s]",
       {"0", "30", "30", "60"},
       ":4: the time (column \"time\") stays the same from line 3 to line 4"},
      {"time [s]", {"0", "30", "30", "60"}, "keep one of the lines"},
      {"time [s]",
       {"0", "30", "20"},
       ":4: the time (column \"time\") falls from line 3 to line 4; it must ascend: "
       "line 3 or line 4 stands in a wrong place"},
      {"time [s]", {"90", "60", "30", "0"}, "it descends throughout: write the lines in the reverse order"},
      {"time [h:mm:ss]",
       {"11:50:00", "12:00:00", "12:50:00", "01:00:00"},
       "the clock begins anew after 12 h there; write times since the start of heating: add 12 h from line "
       "5"},
      {"time [h]", {"23.5", "23.9", "0.3", "0.7"}, "the clock passes midnight"},
      {"time [s]",
       {"86200", "86300", "0", "100"},
       "add 24 h from line 4 on, and subtract the time of the start"},
      {"time [s]",
       {"0", "60", "120", "0", "60", "120"},
       "the record begins again there: keep one of its parts, the "
       "lines up to 4 or those from 5 on"},
      {"time",
       {"00:00:00", "00:01:00", "00:02:00", "00:00:30", "00:01:30", "00:02:30"},
       "the record begins again"},
      {"time [s]",
       {"600", "660", "720", "0", "60", "120"},
       "the lines from 5 on are less than all before: keep one of the two parts, or put them first"},
      {"time [s]",
       {"0", "60", "0", "60", "0", "60"},
       "it falls 2 times, as where several records stand in turn"}};
  for (const auto& [header, times, told] : cases) {
    const std::string text = refusal(record_of(header, times));
    expect_in(told, text);
    expect_out("sort", text);
  }
}

// Promise: times that count from a date are told as such.
TEST(MeasuredTable, RefusesTimesSinceAYear) {
  for (const auto& [header, time] : {std::pair("time [s]", "1700000000"), std::pair("time [ms]", "1.7e12"),
                                     std::pair("time [d]", "45000.25"), std::pair("time [h]", "472222")})
    expect_in("it counts from a date", refusal(record_of(header, {time, "1e13"})));
  const std::string text = refusal(record_of("time [s]", {"1700000000", "1700000060"}));
  expect_in(
      "furnace.csv:2: the time (column \"time\") begins at 1700000000 s, 53.9 years: it counts from a date",
      text);
  expect_in("write start = \"first row\" beside the file's name, or the time of the start", text);
}

/// Times of a record that a deck reads with a start, or without.
std::vector<double> seconds(const std::string& header, const std::vector<std::string>& times,
                            const std::string& start = "") {
  ColumnChoice choice{"furnace.csv", {}, {}};
  choice.start = start;
  std::vector<double> result;
  for (const auto& [time, temperature] : layouts::read(record_of(header, times), choice))
    result.push_back(time);
  return result;
}

// Promise: dates with times and times of the day are read as times since the first row, however they are
// written.
TEST(MeasuredTable, ReadsStampsAsTimesSinceTheFirstRow) {
  struct Case {
    std::string header;
    std::vector<std::string> times;
    double last;
  };
  const Case cases[] = {
      {"Zeit", {"2026-03-02T10:14:05", "2026-03-02T10:14:20", "2026-03-02T10:44:05"}, 1800.0},
      {"Zeit", {"2026-03-02 10:14:05", "2026-03-02 10:14:20", "2026-03-02 10:44:05"}, 1800.0},
      {"Zeit [s]", {"2026-03-02T10:14:05", "2026-03-02T10:44:05"}, 1800.0},
      {"Time (UTC)", {"2026-03-02T10:14:05Z", "2026-03-02T10:14:05.5Z"}, 0.5},
      {"Time [local time]", {"2026-03-02T10:14:05,25", "2026-03-02T10:14:05,75"}, 0.5},
      {"timestamp", {"2026-03-29T01:59:59+01:00", "2026-03-29T03:00:01+02:00"}, 2.0},
      {"timestamp", {"2026-03-29 01:59:59 -0130", "2026-03-29 03:30:09 +0000"}, 10.0},
      {"DateTime", {"20260302T235955", "20260303T000005"}, 10.0},
      {"Date/Time", {"2026/12/31 23:59:50", "2027/01/01 00:00:20"}, 30.0},
      {"Zeitstempel", {"28.02.2028 23:59:59", "01.03.2028 00:00:01"}, 86402.0},
      {"Datum/Uhrzeit", {"31.12.26, 23:59", "01.01.27, 00:01"}, 120.0},
      {"t", {"02/03/2026 10:14:05", "02/03/2026 10:14:35"}, 30.0},
      {"t", {"2/3/26 10:14:05 AM", "2/3/26 12:14:05 PM"}, 7200.0},
      {"t", {"02/13/2026 23:59:00", "02/14/2026 00:01:00"}, 120.0},
      {"t [dd/mm/yyyy hh:mm:ss]", {"02/03/2026 23:59:00", "03/03/2026 00:01:00"}, 120.0},
      {"t [MM/dd/yyyy HH:mm]", {"02/28/2026 23:59", "03/01/2026 00:01"}, 120.0},
      {"Uhrzeit", {"10:14:05", "10:14:20", "10:44:05"}, 1800.0},
      {"Uhrzeit", {"10:14:05.125", "10:14:05.375"}, 0.25},
      {"time [hh:mm]", {"10:00", "16:00", "22:00", "04:00", "11:00"}, 90000.0},
      {"time", {"23:50:00", "23:55:00", "00:00:00", "00:05:00"}, 900.0},
      {"time", {"00:50:00", "12:50:00", "00:50:00"}, 86400.0},
      {"time", {"11:59:58 PM", "12:00:08 AM"}, 10.0},
      {"time", {"25:00:00", "26:00:00"}, 93600.0},  // no clock shows 25
      {"time", {"00:00:15", "00:00:45"}, 45.0},     // rather since a start
      {"time [mm:ss]", {"75:10", "80:10"}, 4810.0}};
  for (const auto& [header, times, last] : cases) {
    std::vector<double> read;
    ASSERT_NO_THROW(read = seconds(header, times)) << header << times[0];
    EXPECT_EQ(read.back(), last) << header << times[0];
  }
}

// Promise: a deck states which time of a record counts as 0.
TEST(MeasuredTable, CountsTimesFromTheStartThatADeckStates) {
  using Times = std::vector<double>;
  EXPECT_EQ(seconds("time", {"10:14:05", "10:14:20"}, "10:14:00"), (Times{5.0, 20.0}));
  EXPECT_EQ(seconds("time", {"10:14:05", "10:14:20"}, "10:14:06"), (Times{-1.0, 14.0}));
  EXPECT_EQ(seconds("time", {"10:14:05", "10:14:20"}, "0:00:00"), (Times{36845.0, 36860.0}));
  EXPECT_EQ(seconds("time", {"00:00:15", "00:00:45"}, "first row"), (Times{0.0, 30.0}));
  EXPECT_EQ(seconds("time", {"23:59:00", "00:01:00"}, "00:00:00"), (Times{-60.0, 60.0}));
  EXPECT_EQ(seconds("time", {"00:01:00", "00:02:00"}, "23:59:00"), (Times{120.0, 180.0}));
  EXPECT_EQ(seconds("time", {"2026-03-02T23:59:00", "2026-03-03T00:01:00"}, "2026-03-03T00:00:30"),
            (Times{-90.0, 30.0}));
  EXPECT_EQ(seconds("time [min]", {"5", "35"}, "300 s"), (Times{0.0, 1800.0}));
  EXPECT_EQ(seconds("time [s]", {"1700000000", "1700000060"}, "first row"), (Times{0.0, 60.0}));
  const auto told = [](const std::string& header, const std::vector<std::string>& times,
                       const std::string& start) { return message([&] { seconds(header, times, start); }); };
  expect_in("start = \"10:14\" is not written as the times of column \"time\"; write it like \"10:14:05\"",
            told("time", {"10:14:05", "10:14:20"}, "10:14"));
  expect_in("start = \"10:14:05\" is not written as the times",
            told("time", {"2026-03-02T10:14:05", "2026-03-02T10:14:20"}, "10:14:05"));
  expect_in("start = \"11:00:00\" comes after the last time, \"10:14:20\" in column \"time\"",
            told("time", {"10:14:05", "10:14:20"}, "11:00:00"));
  expect_in("write \"first row\", or a time such as \"5 min\"", told("time [min]", {"5", "35"}, "soon"));
}

// Promise: of two readings of a date none is chosen, and a column holds times of one kind.
TEST(MeasuredTable, RefusesStampsThatAreNotCertain) {
  const std::string order = refusal(record_of("t", {"02/03/2026 23:59:00", "03/03/2026 00:01:00"}));
  expect_in("furnace.csv:3: \"03/03/2026 00:01:00\" in column \"t\" is a date, of which the order", order);
  expect_in("it is 1 or 28 days after \"02/03/2026 23:59:00\"", order);
  expect_in("\"dd/mm/yyyy hh:mm:ss\" or \"mm/dd/yyyy hh:mm:ss\", above it or in `units`", order);
  for (const auto& [first, second] :
       {std::pair("2026-03-02T10:14:05", "10:14:20"), std::pair("2026-03-02T10:14:05", "02.03.2026 10:14:20"),
        std::pair("2026-03-02T10:14:05", "2026-03-02T10:14:20Z"), std::pair("10:14:05 AM", "10:14:20")})
    expect_in(fmt::format("furnace.csv:3: \"{}\" in column \"t\" is written otherwise than \"{}\" in line 2",
                          second, first),
              refusal(record_of("t", {first, second})));
  expect_in("furnace.csv:3: \"2026-02-30T10:00\" in column \"t\" is no day of the calendar",
            refusal(record_of("t", {"2026-02-28T10:00", "2026-02-30T10:00"})));
  expect_in("\"13:00:00 PM\" in column \"t\" is no",
            refusal(record_of("t", {"11:00:00 AM", "13:00:00 PM", "14:00:00 PM"})));
}

// Promise: a date beside a clock in a column of its own is passed over, however cells are separated.
TEST(MeasuredTable, PassesOverDatesBesideAClock) {
  const Record two{{0.0, 20.0}, {900.0, 800.0}};
  for (const std::string text : {"Datum;Uhrzeit;T [°C]\n02.03.2026;23:50:00;20\n03.03.2026;00:05:00;800\n",
                                 "Date,Time,T [degC]\n2026-03-02,10:14:05,20\n2026-03-02,10:29:05,800\n",
                                 "Date Time T/degC\n2026-03-02 10:14:05 20\n2026-03-02 10:29:05 800\n",
                                 "Time,T [degC]\n2026-03-02 10:14:05,20\n2026-03-02 10:29:05,800\n"})
    expect_same(layouts::read(text), two, text);
}

// Promise: blanks and apostrophes between thousands, and Fortran's powers, are read.
TEST(MeasuredTable, ReadsSignsBetweenThousandsAndPowersOfFortran) {
  const Record record{{0.0, 20.0}, {1200.0, 1049.5}};
  for (const std::string blank : {" ", "\u00A0", "\u202F", "\u2009", "'", "\u2019"})
    for (const std::string rows :
         {"0;20\n1_200;1_049.5\n", "0;20\n1_200;1_049,5\n", "0\t20\n1_200\t1_049.5\n",
          "0,20\n1_200,1_049.5\n", "0;20\n\"1_200\";\"1049,5\"\n"}) {
      std::string text = "time [s]";
      text.append(1, rows[1]).append("T [degC]\n").append(rows);
      for (std::size_t at = 0; (at = text.find('_')) != text.npos;) text.replace(at, 1, blank);
      Record read;
      ASSERT_NO_THROW(read = layouts::read(text)) << text;
      expect_same(read, record, text);
    }
  for (const std::string row : {"1.2D+03 1049.5D0", "0.12D+04 1.0495d+03", "1.2E+03 1.0495D+03"}) {
    const std::string text = "time [s] T [degC]\n0.0D+00 2.0D+01\n" + row + "\n";
    expect_same(layouts::read(text), record, text);
  }
  expect_in("no number", refusal("time [s];T [degC]\n0;20\n1 20;30\n60;40\n"));
  expect_in("no number", refusal("time [s];T [degC]\n0;20\n1'200 300;30\n60;40\n"));
  expect_in("1200 for 1 200, as blanks stand between columns",
            refusal("time [s] T [degC]\n0 20\n1 200 30\n1 300 40\n"));
}

TEST(MeasuredTable, NamesCellsThatAreNoNumbers) {
  const std::string header = "time [s],T [degC]\n";
  expect_in("furnace.csv:3: \"n/a\" in column \"T\" is no number", refusal(header + "0,20\n30,n/a\n60,30\n"));
  expect_in("furnace.csv:3: column \"T\" is empty", refusal(header + "0,20\n30,\n60,30\n"));
  expect_in("furnace.csv:3: \"30\" has 1 cell, line 1 has 2", refusal(header + "0,20\n30\n60,30\n"));
  expect_in("furnace.csv:4: \"END\" holds no number (delimiter: \",\"); delete the line or write # before it",
            refusal(header + "0,20\n30,30\nEND\n"));
  expect_in("not finite", refusal(header + "0,20\n30,1e999\n"));
  expect_in(
      "furnace.csv:1: \"time [s],T [degC]\" holds no number; rows of numbers must follow "
      "the header",
      refusal(header));
  expect_in("a quote does not close", refusal(header + "0,\"20\n30,30\n"));
  expect_in("is empty", refusal(""));
  expect_in("is empty", refusal("\n# nothing\n"));
  expect_in("3 lines without numbers stand above the first row of numbers, beginning with \"Logger 7;\"",
            refusal("Logger 7;\nTime;T\ns;degC\n0;20\n1;30\n"));
  expect_in("lines 1 and 2 hold no numbers, and neither is a row of units",
            refusal("Logger;seven\nTime;T\n0;20\n1;30\n"));
}

TEST(MeasuredTable, TellsOtherEncodings) {
  const std::string text = "time [s],T [degC]\n0,20\n30,30\n";
  std::string little, big;
  for (const char c : text) {
    little += {c, '\0'};
    big += {'\0', c};
  }
  expect_in(
      "furnace.csv: is UTF-16, not UTF-8; write `iconv -f UTF-16 -t UTF-8 furnace.csv > utf8_furnace.csv`",
      refusal("\xFF\xFE" + little));
  expect_in("iconv -f UTF-16 -t", refusal("\xFE\xFF" + big));
  expect_in("iconv -f UTF-16LE -t", refusal(little));
  expect_in("iconv -f UTF-16BE -t", refusal(big));
  expect_in(
      "furnace.csv:1: byte 0xB0 is not UTF-8, but of Latin-1 or Windows; write `iconv -f WINDOWS-1252 -t "
      "UTF-8 ",
      refusal("time [s],T [\xB0"
              "C]\n0,20\n30,30\n"));
  expect_in("furnace.csv:3: holds a byte 0", refusal(std::string("a\rb\r\nc\0", 7)));
}

}  // namespace
}  // namespace pyroclast
