// What a batch varies besides the seed, its columns, and the page that shows them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "app/batch/sweep.h"
#include "app/batch/csv_table.h"
#include "app/report/html_text.h"
#include "app/report/score_means.h"
#include "app/report/svg_plot.h"
#include "kernel/base/error.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace sweep_test {

namespace fs = std::filesystem;

#define EXPECT_IN(part, text) EXPECT_NE((text).find(part), std::string::npos) << (text)

std::string mistake_of(const std::vector<std::string>& varied, int samples) {
  try {
    make_sweep(varied, samples);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Sweep, WithoutAnythingVariedThereIsOneVariant) {
  const Sweep sweep = make_sweep({}, 0);
  ASSERT_EQ(sweep.variants.size(), 1u);
  EXPECT_TRUE(sweep.overrides(0).empty());
  EXPECT_EQ(sweep.run_name(0, "7"), "seed_7");
}

TEST(Sweep, ListsGiveEveryCombinationOnce) {
  const Sweep sweep = make_sweep({"fogdensity=0,0.1,0.3", "lamp.intensity_cd=20,60"}, 0);
  ASSERT_EQ(sweep.variants.size(), 6u);
  EXPECT_EQ(sweep.overrides(0), (std::vector<std::string>{"fogdensity=0", "lamp.intensity_cd=20"}));
  EXPECT_EQ(sweep.overrides(1), (std::vector<std::string>{"fogdensity=0", "lamp.intensity_cd=60"}));
  EXPECT_EQ(sweep.overrides(5), (std::vector<std::string>{"fogdensity=0.3", "lamp.intensity_cd=60"}));
  const std::set<std::vector<std::string>> different(sweep.variants.begin(), sweep.variants.end());
  EXPECT_EQ(different.size(), 6u);
  EXPECT_EQ(sweep.run_name(5, "7"), "v6_seed_7");
}

// The defining property of a Latin hypercube: each equal part of each range holds one sample.
TEST(Sweep, ALatinHypercubeHasOneSampleInEveryPartOfEveryRange) {
  const int samples = 40;
  const Sweep sweep = make_sweep({"fogdensity=0.5..2.5", "wetness=0..1"}, samples);
  ASSERT_EQ(sweep.variants.size(), std::size_t(samples));
  const double low[] = {0.5, 0}, width[] = {2, 1};
  double product = 0;
  for (std::size_t key = 0; key < 2; ++key) {
    std::set<int> parts;
    for (const auto& variant : sweep.variants) {
      const double at = (std::stod(variant[key]) - low[key]) / width[key];
      ASSERT_TRUE(at >= 0 && at <= 1) << variant[key];
      parts.insert(std::min(samples - 1, int(at * samples + 1e-9)));
    }
    EXPECT_EQ(parts.size(), std::size_t(samples));
  }
  for (const auto& variant : sweep.variants)
    product += (std::stod(variant[0]) - 1.5) / 2 * (std::stod(variant[1]) - 0.5);
  // Were both keys matched in order, it would be the variance of a uniform number, 1/12.
  EXPECT_LT(std::abs(product / samples), 0.5 / 12) << "the keys are matched at random";
  EXPECT_EQ(make_sweep({"fogdensity=0.5..2.5", "wetness=0..1"}, samples).variants, sweep.variants);
}

// Six digits do not tell the samples of a narrow range or of a stamp apart.
TEST(Sweep, SamplesHaveAsManyDigitsAsTheirRangeNeeds) {
  const struct { const char* key; double low, high; } ranges[] = {
      {"start_ns", 1700000000000000000.0, 1700000001000000000.0},
      {"light.position.x", 999.99991, 999.99999},
      {"trajectory.rate_hz", 1e-3, 1.0000001e-3}};
  for (const auto& range : ranges) {
    char text[120];
    std::snprintf(text, sizeof text, "%s=%.17g..%.17g", range.key, range.low, range.high);
    std::set<int> parts;
    for (const auto& variant : make_sweep({text}, 10).variants) {
      const double at = (std::stod(variant[0]) - range.low) / (range.high - range.low);
      ASSERT_TRUE(at >= 0 && at <= 1) << variant[0];
      parts.insert(std::min(9, int(at * 10)));
      if (range.low > 1e6) {
        EXPECT_EQ(variant[0].find_first_not_of("0123456789"), std::string::npos) << variant[0];
      }
    }
    EXPECT_EQ(parts.size(), 10u) << text;
  }
}

TEST(Sweep, WholeNumbersStayWholeAndReachBothEnds) {
  std::set<std::string> seen;
  for (const auto& variant : make_sweep({"pile.layers=1..4"}, 40).variants) seen.insert(variant[0]);
  EXPECT_EQ(seen, (std::set<std::string>{"1", "2", "3", "4"}));
}

TEST(Sweep, CombinesPointsWithLists) {
  const Sweep sweep = make_sweep({"wetness=0..1", "pile.layers=2,3"}, 5);
  EXPECT_EQ(sweep.variants.size(), 10u);
  EXPECT_EQ(sweep.keys, (std::vector<std::string>{"wetness", "pile.layers"}));
}

TEST(Sweep, SaysWhatIsWrong) {
  EXPECT_IN("--vary", mistake_of({"fogdensity"}, 0));
  EXPECT_IN("--seeds gives the seeds", mistake_of({"seed=1,7"}, 0));
  EXPECT_IN("--seeds gives the seeds", mistake_of({"seed=1..7"}, 3));
  EXPECT_IN("a value is empty", mistake_of({"fogdensity=1,,2"}, 0));
  EXPECT_IN("a value occurs twice", mistake_of({"fogdensity=1,2,1"}, 0));
  EXPECT_IN("varied twice", mistake_of({"a=1,2", "a=3,4"}, 0));
  EXPECT_IN("the range is empty", mistake_of({"a=2..1"}, 3));
  EXPECT_IN("--samples", mistake_of({"a=1..2"}, 0));
  EXPECT_IN("no range to sample", mistake_of({"a=1,2"}, 5));
  const std::string many = "=1,2,3,4,5,6,7,8,9,10";
  EXPECT_IN("too many combinations",
            mistake_of({"a" + many, "b" + many, "c" + many, "d" + many, "e" + many, "f" + many}, 0));
}

TEST(Csv, ReadsWhatRfc4180Writes) {
  const CsvTable table = parse_csv("a,\"b,1\"\r\n1,\"say \"\"no\"\"\nor\"\n2,\n", "t.csv");
  EXPECT_EQ(table.columns, (std::vector<std::string>{"a", "b,1"}));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0][1], "say \"no\"\nor");
  EXPECT_EQ(table.find("b,1"), 1);
  EXPECT_EQ(table.find("c"), -1);
  EXPECT_THROW(parse_csv("a,b\n1\n", "t.csv"), InputError);
  EXPECT_THROW(parse_csv("a,\"b\n", "t.csv"), InputError);
  EXPECT_THROW(parse_csv("", "t.csv"), InputError);
}

TEST(HtmlText, EscapesAndEncodes) {
  EXPECT_EQ(html_escape("<a b=\"c\">&"), "&lt;a b=&quot;c&quot;&gt;&amp;");
  EXPECT_EQ(url_escape("a b/\xc3\xa9?#"), "a%20b/%C3%A9%3F%23");
  // RFC 4648, section 10.
  for (const auto& [plain, coded] : {std::pair("", ""), {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"},
                                     {"foob", "Zm9vYg=="}, {"fooba", "Zm9vYmE="}, {"foobar", "Zm9vYmFy"}})
    EXPECT_EQ(base64(plain), coded);
}

TEST(SvgPlot, CountsEveryValueOnceAndDrawsEveryPoint) {
  const std::string bars = make_histogram("h", {0, 1, 1, 2, 10}, 10);
  EXPECT_IN("0 to 1: 1<", bars);
  EXPECT_IN("1 to 2: 2<", bars);
  EXPECT_IN("9 to 10: 1<", bars);
  const std::string dots = make_scatter("x", "y<", {{0, 1, "a", false}, {1, 2, "b&", true}});
  EXPECT_EQ(std::count(dots.begin(), dots.end(), '\n'), 1);
  EXPECT_IN("cx=\"46\" cy=\"140\"", dots);
  EXPECT_IN("class=\"dot bad\" cx=\"272\" cy=\"18\"", dots);
  EXPECT_IN("b&amp;", dots);
  EXPECT_EQ(make_histogram("h", {}), "");
}

class SweptBatch : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string text = kTinyMission;
    text.insert(0, "local r = rubble.random('how wet, \"really\"')\n"
                   "local wet, stone = r:uniform(0, 1), rubble.random('stone'):choice { 'brick' }\n");
    text.replace(text.find("\"brick\""), 7, "stone");
    text.insert(text.find("seed = 3,") + 9, " wetness = wet,");
    write_file(scratch / "tiny.lua", text);
  }
  std::string batch(const std::string& out, const std::string& more) {
    return "batch " + (scratch / "tiny.lua") + " --seeds 1,2 --vary pile.pieces_per_layer=3,5" +
           " --vary \"pile.spawn_position.z=1.5,2\" --jobs 1 --out " + (scratch / out) + " " + more;
  }
  ScratchFolder scratch;
};

TEST_F(SweptBatch, HasSweptAndDrawnValuesAsColumns) {
  const Outcome whole = run_rubble(batch("whole", "--pile-only"));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const std::string text = read_file(scratch / "whole/index.csv");
  const CsvTable table = parse_csv(text, "index.csv");
  EXPECT_EQ(text.rfind("seed,status,state_hash,bytes,variant,pile.pieces_per_layer,pile.spawn_position.z,"
                       "\"random.how wet, \"\"really\"\"\",random.stone,", 0), 0u) << text;
  ASSERT_EQ(table.rows.size(), 8u);
  const auto at = [&](std::size_t row, const char* name) { return table.rows[row][std::size_t(table.find(name))]; };
  EXPECT_EQ(at(0, "pieces"), "6");  // two layers
  EXPECT_EQ(at(7, "pieces"), "10");
  EXPECT_EQ(at(7, "variant") + at(7, "seed") + at(7, "pile.spawn_position.z"), "422");
  EXPECT_EQ(at(3, "random.stone"), "brick");
  // The value is that of the seed, whatever is varied; another seed has another.
  const char* wet = "random.how wet, \"really\"";
  EXPECT_EQ(at(0, wet), at(2, wet));
  EXPECT_NE(at(0, wet), at(1, wet));
  EXPECT_IN("\"wetness\": " + at(0, wet), run_rubble("check " + (scratch / "tiny.lua") + " --seed 1").out);
  EXPECT_NE(at(0, "state_hash"), at(4, "state_hash"));
  // Shards together give the same table.
  for (const char* shard : {"2/3", "1/3", "3/3"})
    ASSERT_EQ(run_rubble(batch("parts", std::string("--pile-only --shard ") + shard)).exit_code, 0);
  EXPECT_EQ(read_file(scratch / "parts/index.csv"), text);
  const Outcome info = run_rubble("info " + (scratch / "parts"));
  EXPECT_IN("done                     8", info.out);
}

TEST_F(SweptBatch, RefusesBadValuesBeforeItBegins) {
  const Outcome value = run_rubble(batch("a", "--pile-only --vary wetness=0.5,7"));
  EXPECT_EQ(value.exit_code, 1);
  EXPECT_IN("wetness", value.err);
  EXPECT_FALSE(fs::exists(scratch / "a/v1_seed_1"));
  EXPECT_EQ(run_rubble(batch("a", "--vary nothing.there=1,2")).exit_code, 1);
  EXPECT_EQ(run_rubble(batch("a", "--samples 3")).exit_code, 1);
  const Outcome seed = run_rubble(batch("a", "--pile-only --set seed=7"));
  EXPECT_EQ(seed.exit_code, 1);
  EXPECT_IN("--seeds gives the seeds of a batch", seed.err);
  ASSERT_EQ(run_rubble(batch("b", "--pile-only --shard 1/8")).exit_code, 0);
  const Outcome other = run_rubble(batch("b", "--pile-only --vary wetness=0,1"));
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_IN("another batch is in the output folder", other.err);
}

TEST_F(SweptBatch, ReportShowsEveryRunAndNeedsNothingElse) {
  ASSERT_EQ(run_rubble(batch("whole", "--set camera.quality=draft")).exit_code, 0);
  const Outcome made = run_rubble("report " + (scratch / "whole") + " --pictures 5 --width 64");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string page = read_file(scratch / "whole/report.html");
  for (const char* part : {"<h1>tiny.lua</h1>", "8 runs, seeds 1,2, 8 done", "Over pile.pieces_per_layer",
                           "href=\"v4_seed_2/\"", "Further runs, without pictures here (--pictures): 3.", "<h3>By pile.pieces_per_layer</h3>",
                           "Each row is over all values of the other keys.", "sd ", "random.how wet, &quot;really&quot;"})
    EXPECT_IN(part, page);
  std::size_t pictures = 0;
  for (std::size_t at = 0; (at = page.find("src=\"data:image/jpeg;base64,/9j/", at)) != std::string::npos; ++at)
    ++pictures;
  EXPECT_EQ(pictures, 5u);
  for (const char* outside : {"http://", "https://", "src=\"/", "@import", "url("})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside << " leads out of the page";
  ASSERT_EQ(run_rubble("report " + (scratch / "whole") + " --out " + (scratch / "r.html")).exit_code, 0);
  const Outcome taken = run_rubble("report " + (scratch / "whole") + " --out " + (scratch / "whole") + "/index.csv");
  EXPECT_EQ(taken.exit_code, 1);
  EXPECT_IN("--out: would replace a file of the batch", taken.err);
  EXPECT_IN("href=\"whole/v4_seed_2/\"", read_file(scratch / "r.html"));
}

FinishedBatch batch_of(std::vector<std::vector<std::string>> rows) {
  FinishedBatch batch;
  batch.table.columns = {"seed", "status", "wetness", "height", "settled"};
  batch.table.rows = std::move(rows);
  return batch;
}

// 1, 2, 3, 4, 5: mean 3, deviation sqrt(2.5), and 2.776 of it over the root of 5.
TEST(ScoreMeans, AreThoseOfTheTextbook) {
  const StudentInterval five = calc_student_interval({1, 2, 3, 4, 5});
  EXPECT_EQ(five.count, 5u);
  EXPECT_NEAR(five.mean, 3, 1e-12);
  EXPECT_NEAR(five.deviation, 1.5811, 1e-4);
  EXPECT_NEAR(five.half, 1.9629, 1e-3);
  EXPECT_NEAR(calc_student_interval({0, 1}).half, 12.706 * 0.5, 1e-3);
  std::vector<double> many;
  for (int i = 0; i < 51; ++i) many.push_back(i);
  EXPECT_NEAR(calc_student_interval(many).half, 2.0086 * std::sqrt(51.0 * 52 / 12) / std::sqrt(51.0), 5e-3);
  EXPECT_EQ(calc_student_interval({7}).half, 0) << "one run says nothing of others";
  EXPECT_EQ(calc_student_interval({}).count, 0u);
  const ShareInterval all = calc_share_interval(5, 5);  // Wilson: 1 / (1 + z2 / n)
  EXPECT_NEAR(all.low, 1 / (1 + 1.959964 * 1.959964 / 5), 1e-6);
  EXPECT_EQ(all.high, 1);
  EXPECT_NEAR(calc_share_interval(10, 20).low, 0.2993, 1e-4);
}

TEST(ScoreMeans, ByValueOfAKeyWithTheNumberOfRuns) {
  const FinishedBatch batch = batch_of({{"1", "done", "0.5", "1", "1"}, {"2", "done", "0.5", "3", "1"},
                                        {"3", "did_not_settle", "10", "8", "0"}, {"4", "failed", "10", "", ""},
                                        {"5", "done", "2", "", "1"}});
  const std::string page = make_mean_tables(batch, {"wetness"}, {3, 4});
  for (const char* part : {"1 run without scores is not counted", "1 run that did not settle is counted",
                           "<tr><td>all</td><td>4</td><td>4.0 ± 9.0<small>sd 3.6, n 3</small></td><td>3 of 4<small>30 to 95 %",
                           "<tr><td>0.5</td><td>2</td><td>2 ± 13<small>sd 1.4, n 2</small></td><td>2 of 2<small>34 to 100 %",
                           "<tr><td>2</td><td>1</td><td>none</td>", "<tr><td>10</td><td>1</td><td>8<small>n 1: no interval</small></td>"})
    EXPECT_IN(part, page);
  EXPECT_LT(page.find("<td>2</td><td>1"), page.find("<td>10</td><td>1")) << "as numbers";
  EXPECT_EQ(page.find("over all values of the other keys"), std::string::npos);
  EXPECT_EQ(make_mean_tables(batch, {"wetness"}, {}), "");
  FinishedBatch counted = batch;
  counted.table.columns[4] = "void_count";
  EXPECT_IN("<td>0.75 ± 0.80<small>sd 0.50, n 4</small></td>", make_mean_tables(counted, {"wetness"}, {4}));
}

TEST(ScoreMeans, ByRangesWhereThereAreManyValues) {
  std::vector<std::vector<std::string>> rows;
  for (int i = 0; i < 20; ++i) rows.push_back({std::to_string(i), "done", std::to_string(i), std::to_string(2 * i), "1"});
  const std::string page = make_mean_tables(batch_of(rows), {"wetness"}, {3});
  for (const char* part : {"<td>0 to 3</td><td>4</td><td>3.0 ± 4.1<", "<td>16 to 19</td><td>4</td><td>35.0 ± 4.1<"}) EXPECT_IN(part, page);
  EXPECT_EQ(page.find("<td>4</td><td>1</td>"), std::string::npos);
}

TEST_F(SweptBatch, ReportSaysWhatItNeeds) {
  const Outcome none = run_rubble("report " + (scratch / "."));
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_IN("there is no finished batch", none.err);
  fs::create_directories(scratch / "cut");
  write_file(scratch / "cut/batch.json", R"({"script": {"name": "a"}, "seeds": "1", "program": "p"})");
  write_file(scratch / "cut/index.csv", "seed,status\n1\n");
  const Outcome cut = run_rubble("report " + (scratch / "cut"));
  EXPECT_EQ(cut.exit_code, 1);
  EXPECT_IN("index.csv:2", cut.err);
}

class NightlyReport : public SweptBatch {};

// A browser sorts the table when its address asks for it. Chromium prints the page as it then is.
TEST_F(NightlyReport, SortsInABrowser) {
  if (std::system("command -v chromium >/dev/null") != 0) GTEST_SKIP() << "chromium is not installed";
  ASSERT_EQ(run_rubble(batch("whole", "--pile-only")).exit_code, 0);
  ASSERT_EQ(run_rubble("report " + (scratch / "whole")).exit_code, 0);
  const std::string command = "chromium --headless --no-sandbox --disable-gpu --dump-dom --user-data-dir=" +
                              (scratch / "profile") + " 'file://" + (scratch / "whole/report.html") +
                              "#sort=-pile.pieces_per_layer' >" + (scratch / "dom") + " 2>" + (scratch / "err");
  ASSERT_EQ(std::system(command.c_str()), 0) << read_file(scratch / "err");
  const std::string dom = read_file(scratch / "dom");
  EXPECT_IN("aria-sort=\"descending\"", dom);
  const std::size_t body = dom.find("<tbody>", dom.find("<table class=\"runs\">"));
  ASSERT_NE(body, std::string::npos) << dom.substr(0, 2000);
  EXPECT_LT(dom.find("v3_seed_1/", body), dom.find("v1_seed_1/", body));
  const std::string plain = read_file(scratch / "whole/report.html");
  const std::size_t table = plain.find("<table class=\"runs\">");
  EXPECT_GT(plain.find("v3_seed_1/", table), plain.find("v1_seed_1/", table));
}

}  // namespace sweep_test
}  // namespace rubble::testing
