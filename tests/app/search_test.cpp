// Victims in the voids of piles, and the benchmark that searches for them.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "app/eval/scores/confidence.h"
#include "app/mission/finished_run.h"
#include "app/pipeline/stages.h"
#include "app/search/agent_process.h"
#include "app/search/program_agent.h"
#include "app/search/search_bench.h"
#include "app/victims/place_victims.h"
#include "kernel/base/portable_math.h"
#include "kernel/queries/queries.h"
#include "kernel/robot/drive_commands.h"
#include "scripting/robots/crawler.h"
#include "kernel/robot/robot_run.h"
#include "kernel/world/world_robots.h"
#include "tests/app/program.h"
#include "tests/app/tiny_run.h"

namespace rubble::testing {
namespace search_test {

using Json = nlohmann::json;

// A slab on a wall, and a few bricks: settles in a moment.
const char* const kMission = R"(
return rubble.mission {
  seed = 2,
  victims = { count = 2, difficulty = "easy" },
  pile = rubble.collapse.lean_to { length = 5, height = 2, debris = { layers = 0 } },
  camera = { width = 64, height = 48 },
  trajectory = { rate_hz = 5, waypoints = { { t = 0, position = { -5, 0, 2 }, look_at = { 0, 0, 0.5 } },
                                            { t = 0.4, position = { -5, 0.2, 2 }, look_at = { 0, 0, 0.5 } } } },
})";

struct Settled {
  ResolvedMission mission;
  PileState pile;
};

Settled settle_with(const ScratchFolder& folder, const std::string& difficulty, int threads, std::uint64_t seed = 2) {
  write_file(folder / "m.lua", kMission);
  RunRequest request;
  request.mission = folder / "m.lua", request.seed = seed;
  request.overrides = {"victims.difficulty=" + difficulty};
  request.options.quiet = true, request.options.threads = threads;
  RunContext context(request.options);
  Settled settled{resolve_mission(request, RunKind::settle, context), {}};
  settled.pile = settle_in_memory(settled.mission, context, [] { return true; }).state;
  return settled;
}

TEST(Victims, LieOnSomethingAndInNothingTheSameWithAnyNumberOfThreads) {
  const ScratchFolder folder;
  const Settled one = settle_with(folder, "easy", 1), two = settle_with(folder, "easy", 2);
  EXPECT_EQ(one.pile.state_hash(), two.pile.state_hash());
  EXPECT_NE(one.pile.state_hash(), settle_with(folder, "easy", 1, 3).pile.state_hash());
  const std::vector<Victim> victims = find_victims(one.pile);
  ASSERT_EQ(victims.size(), 2u);
  PileState without = one.pile;
  without.pieces.resize(one.pile.pieces.size() - 2);
  const std::vector<const TriangleMesh*> meshes = one.mission.assets.finest_meshes();
  const PileQueries queries(without, meshes);
  for (const Victim& victim : victims) {
    const PieceState& piece = one.pile.pieces[std::size_t(victim.piece)];
    double least = 1e9;
    int inside = 0;
    for (const Vec3f& p : meshes[std::size_t(piece.type)]->positions) {
      const double gap = queries.clearance(piece.world_from_body * Vec3(p), 1);
      least = std::min(least, gap);
      inside += gap == 0;
    }
    EXPECT_LT(least, 0.02) << "hangs in the air";
    EXPECT_LT(inside, int(meshes[std::size_t(piece.type)]->positions.size() / 10)) << "lies in something";
    EXPECT_NEAR(distance(victim.trunk, victim.head), 0.53, 0.03);
  }
  EXPECT_GT(distance(victims[0].trunk, victims[1].trunk), 1.1);
}

TEST(Victims, ThatAreHardLieFartherIn) {
  const ScratchFolder folder;
  const auto mean_way = [&](const std::string& difficulty) {
    double sum = 0;
    for (const std::uint64_t seed : {2, 3, 4}) {
      const Settled settled = settle_with(folder, difficulty, 2, seed);
      // The void under the slab opens at its ends, at y = -3 and 3.
      for (const Victim& victim : find_victims(settled.pile)) sum += 3 - std::fabs(victim.trunk.y);
    }
    return sum / 6;
  };
  EXPECT_GT(mean_way("hard"), mean_way("easy") + 0.4);
}

TEST(Victims, AreInEveryProductOfARunAndTheSameWhenItIsMadeAgain) {
  const ScratchFolder folder;
  write_file(folder / "m.lua", kMission);
  const std::string out = folder / "out";
  const Outcome run = run_rubble("run " + (folder / "m.lua") + " --quiet --set camera.quality=draft --out " + out);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(read_file(out + "/victims.json"), nullptr, false);
  ASSERT_TRUE(json.is_object());
  ASSERT_EQ(json["victims"].size(), 2u);
  const PileState pile = load_pile_of(open_finished_run(out));
  for (const Json& one : json["victims"]) {
    const auto piece = one["piece"].get<std::size_t>();
    EXPECT_EQ(pile.types[std::size_t(pile.pieces[piece].type)], one["asset"]);
    EXPECT_EQ(pile.pieces[piece].world_from_body.translation.x, one["trunk"][0].get<double>());
  }
  EXPECT_EQ(run_rubble("verify --quiet " + out).exit_code, 0);
  const Outcome remake = run_rubble("remake --quiet " + out + "/manifest.json --out " + (folder / "again"));
  EXPECT_EQ(remake.exit_code, 0) << remake.out << remake.err;
  EXPECT_EQ(reproducible(folder / "again"), reproducible(out));
  // A camera of another mission over the same pile sees them, too.
  const Outcome render = run_rubble("render " + out + " --quiet --mission scripts/small.lua --out " + (folder / "other"));
  ASSERT_EQ(render.exit_code, 0) << render.err;
  EXPECT_EQ(read_state_hash(folder / "other"), read_state_hash(out));
  EXPECT_EQ(read_file(folder / "other/victims.json"), read_file(out + "/victims.json"));
}

// A crawler of 38 kg drives at one of 75 kg or more: it is stopped, or climbs. One that is twenty times as heavy pushes it.
TEST(Victims, ArePushedByARobotThatIsHeavyEnough) {
  const ScratchFolder folder;
  const Settled settled = settle_with(folder, "easy", 2);
  std::vector<Victim> victims = find_victims(settled.pile);
  ASSERT_EQ(victims.size(), 2u);
  // The nearer one to an open end of the void, which runs along Y from -3 to 3.
  if (std::fabs(victims[1].trunk.y) > std::fabs(victims[0].trunk.y)) std::swap(victims[0], victims[1]);
  const double side = victims[0].trunk.y > 0 ? 1 : -1, half = -side * 0.25 * portable::kPi;
  const Pose start{{portable::cos(half), 0, 0, portable::sin(half)}, {victims[0].trunk.x, side * 4, 0.005}};
  struct Push {
    double moved = 0, other_moved = 0;
    bool touched = false;
  };
  const auto push_with = [&](double speed, double mass) {
    RobotRunOptions options;
    options.duration = 8, options.threads = 2;
    RobotRun run(make_laid_pile(settled.mission, settled.pile), settled.pile, options);
    RobotModel model = make_crawler();
    for (RobotLink& link : model.links) link.mass *= mass, link.inertia = link.inertia * mass;
    run.add(model, start, [&](const RobotSense&) { return drive_sides(model, speed, 0, {1, 1, 1, 1}); });
    Push push;
    run.run([&](double) {
      for (const RobotContact& contact : run.world().robots().contacts(0))
        push.touched = push.touched || (contact.piece == victims[0].piece && contact.force > 0);
      return true;
    });
    const auto moved = [&](const Victim& victim) {
      return distance(run.world().piece(victim.piece).world_from_body.translation,
                      settled.pile.pieces[std::size_t(victim.piece)].world_from_body.translation);
    };
    push.moved = moved(victims[0]), push.other_moved = moved(victims[1]);
    return push;
  };
  const Push light = push_with(0.4, 1), heavy = push_with(0.4, 20), still = push_with(0, 20);
  EXPECT_TRUE(light.touched);
  EXPECT_GT(heavy.moved, 0.1);
  EXPECT_GT(heavy.moved, 5 * light.moved);
  EXPECT_LT(heavy.other_moved, 0.01);
  EXPECT_FALSE(still.touched);
  EXPECT_LT(still.moved, 0.01);
}

TEST(Victims, LieInAMissionWithARobot) {
  const ScratchFolder folder;
  std::string text = kMission;
  text.insert(text.find("camera ="), "robots = { rubble.robot.rover { position = { -3, 0, 0.001 }, drive = { { t = 0, "
                                     "linear = 0.5 } } } }, robot_run = { duration = 1 },\n  ");
  write_file(folder / "r.lua", text);
  const Outcome run = run_rubble("run " + (folder / "r.lua") + " --quiet --set camera.quality=draft --set outputs.bag=false --out " + (folder / "out"));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(read_file(folder / "out/victims.json"), nullptr, false);
  EXPECT_EQ(json["victims"].size(), 2u);
}

TEST(Victims, MistakesAreNamed) {
  const ScratchFolder folder;
  write_file(folder / "m.lua", kMission);
  const Outcome many = run_rubble("settle " + (folder / "m.lua") + " --set victims.count=40 --quiet --out " + (folder / "a"));
  EXPECT_EQ(many.exit_code, 1);
  EXPECT_NE(many.err.find("victims.count: the voids cannot hold so many victims: expected at most "), std::string::npos)
      << many.err;
  const Outcome track = run_rubble("check " + (folder / "m.lua") + " --set outputs.track=true");
  EXPECT_NE(track.err.find("victims.count: victims are placed after the pile has settled"), std::string::npos);
  const Outcome word = run_rubble("check " + (folder / "m.lua") + " --set victims.difficulty=deep");
  EXPECT_NE(word.err.find("\"easy\", \"medium\""), std::string::npos) << word.err;
}

TEST(Confidence, IsThatOfTheNormalDistributionForManyValues) {
  std::vector<double> coins;
  for (int i = 0; i < 400; ++i) coins.push_back(i % 4 == 0 ? 1 : 0);
  const MeanInterval m = calc_mean(coins);
  EXPECT_DOUBLE_EQ(m.mean, 0.25);
  const double half = 1.96 * std::sqrt(0.25 * 0.75 / 400);
  EXPECT_NEAR(m.high - m.mean, half, 0.1 * half);
  EXPECT_NEAR(m.mean - m.low, half, 0.1 * half);
  const MeanInterval again = calc_mean(coins);
  EXPECT_EQ(again.low, m.low);
  const MeanInterval single = calc_mean({7});
  EXPECT_EQ(single.low, 7);
  EXPECT_EQ(single.high, 7);
}

class SearchBench : public ::testing::Test {
 protected:
  void SetUp() override { write_file(folder_ / "m.lua", kMission); }

  Outcome search(const std::string& options) const {
    return run_rubble("bench search " + (folder_ / "m.lua") + " --quiet --force --out " + (folder_ / "out") + " " + options);
  }
  static double value(const Json& table, std::size_t row, const char* key) {
    return table["datasets"][row][key].get<double>();
  }

  ScratchFolder folder_;
};

TEST_F(SearchBench, TheOracleFindsAllAndTheBaselinesFindLessEachTimeTheSame) {
  const std::string options = "--seeds 2 --baseline oracle --baseline frontier --baseline wall --baseline random --baseline octomap --json";
  const Outcome first = search(options);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const Json table = Json::parse(first.out, nullptr, false);
  ASSERT_TRUE(table.is_object()) << first.out;
  ASSERT_EQ(table["datasets"].size(), 5u);
  EXPECT_EQ(value(table, 0, "searches"), 1);
  EXPECT_EQ(value(table, 0, "found_share"), 1);
  EXPECT_EQ(value(table, 0, "false_reports"), 0);
  EXPECT_GT(value(table, 0, "spl"), 0.5);
  EXPECT_GE(value(table, 1, "found_share"), value(table, 3, "found_share"));
  EXPECT_GT(value(table, 1, "found_share"), 0);
  EXPECT_GT(value(table, 4, "found_share"), 0);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_LE(value(table, i, "spl"), value(table, 0, "spl")) << i;
    EXPECT_GT(value(table, i, "coverage"), 0.05) << i;
    EXPECT_LE(value(table, i, "coverage"), 1) << i;
  }
  const std::string searches = read_file(folder_ / "out/searches.csv");
  const Outcome again = search("--seeds 2 --baseline random --baseline frontier --baseline octomap --json --threads 1");
  const Json other = Json::parse(again.out, nullptr, false);
  EXPECT_EQ(other["datasets"][0], table["datasets"][3]);
  EXPECT_EQ(other["datasets"][1], table["datasets"][1]);
  EXPECT_EQ(other["datasets"][2], table["datasets"][4]);
  std::istringstream lines(read_file(folder_ / "out/searches.csv"));
  for (std::string line; std::getline(lines, line);) EXPECT_NE(searches.find(line), std::string::npos) << line;
}

// The agent that docs/explanation/search.md shows.
TEST_F(SearchBench, TheAgentOfTheDocumentFindsSomebody) {
  EXPECT_NE(read_file(RUBBLE_SOURCE_DIR "/docs/explanation/search.md").find("(../../examples/search/agent.py)"), std::string::npos);
  const Outcome outcome = search("--seeds 2..3 --json --agent '/usr/bin/python3 examples/search/agent.py'");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json table = Json::parse(outcome.out, nullptr, false);
  ASSERT_TRUE(table.is_object()) << outcome.out;
  EXPECT_EQ(table["datasets"][0]["name"], "agent");
  EXPECT_GT(value(table, 0, "found_share"), 0);
  EXPECT_GT(value(table, 0, "path_m"), 1);
}

// tools/draw_search.py between the two: the agent flies as it does without.
TEST_F(SearchBench, WhatAnAgentSawIsKeptToBeDrawn) {
  const std::string agent = "/usr/bin/python3 examples/search/agent.py", seen = folder_ / "seen.json";
  ASSERT_EQ(search("--seeds 2 --agent '" + agent + "'").exit_code, 0);
  const std::string alone = read_file(folder_ / "out/searches.csv");
  const Outcome outcome = search("--seeds 2 --agent 'tools/draw_search.py record " + seen + " " + agent + "'");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err << read_file(folder_ / "out/agent_2.log");
  EXPECT_EQ(read_file(folder_ / "out/searches.csv"), alone);
  const Json kept = Json::parse(read_file(seen), nullptr, false);
  ASSERT_TRUE(kept.is_object());
  EXPECT_EQ(kept["end"]["type"], "end");
  EXPECT_EQ(kept["best"]["type"], "observation");
  EXPECT_GT(kept["way"].size(), 10u);
}

TEST(SearchAgents, ThatMisbehaveAreNamedAndEndTheirSearchOnly) {
  const ScratchFolder folder;
  const Settled settled = settle_with(folder, "easy", 2);
  const SearchWorld world(settled.mission, settled.pile, SearchRules(), 2);
  const std::pair<const char*, const char*> cases[] = {
      {"sleep 60", "the agent did not answer for "},
      {"read line; echo so it is >&2; exit 3", "ended with exit code 3 before the search was over; it said last: so it is"},
      {"kill -SEGV $$", "the agent ended by signal 11"},
      {"yes", "the agent floods: "},
      {"tr -d '\\n' < /dev/zero", "the agent floods: "},
      {"read a; while read line; do echo hello; done", "is not understood: expected a JSON object in one line, found hello"},
      {"read a; while read line; do echo '{\"velocity\": [0, 1]}'; done", "three numbers in `velocity`"},
      {"read a; while read line; do echo '{\"speed\": 1}'; done", "not `speed`"},
      {"read a; while read line; do echo '{\"turn\": 1e999}'; done", "1e999"},
      {"exec 2>&-; exec >&-; sleep 60", "the agent closed its output before the search was over"},
      {"/no/such/program", "the agent ended with exit code 127"}};
  for (const auto& [command, words] : cases) {
    const auto start = std::chrono::steady_clock::now();
    const auto agent = start_program_agent({command, folder / "log", 0.5}, make_briefing(world, 1));
    const SearchScore score = play_search(world, 1, *agent);
    EXPECT_NE(score.failure.find(words), std::string::npos) << command << "\n" << score.failure;
    EXPECT_EQ(score.found, 0);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 20) << command;
  }
}

// An agent may start helpers with sessions of their own, as roslaunch does: none of them is left. Each writes its number.
TEST(SearchAgents, LeaveNoProcessBehind) {
  const ScratchFolder folder;
  const std::string helper = folder / "helper";
  const auto helpers = [&] {
    std::vector<int> numbers;
    std::istringstream in(read_file(helper));
    for (int number = 0; in >> number;) numbers.push_back(number);
    return numbers;
  };
  const std::string start = "setsid sh -c 'echo $$ >>" + helper + "; exec sleep 1000' </dev/null >/dev/null 2>&1 & "
                            "(setsid sh -c 'setsid sh -c \"echo \\$\\$ >>" + helper + "; exec sleep 1000\" & exit' </dev/null >/dev/null 2>&1 &) ; "
                            "while [ $(wc -l <" + helper + ") -lt 2 ]; do sleep 0.02; done; ";
  write_file(helper, "");
  for (const char* end : {"read line; echo done", "sleep 1000", "exit 3", "trap '' TERM; read line; echo done; sleep 1000"}) {
    write_file(helper, "");
    {
      AgentProcess agent(start + end, folder / "log");
      const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
      while (helpers().size() < 2 && std::chrono::steady_clock::now() < until)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      if (std::string(end).find("echo done") != std::string::npos) {
        agent.write_line("go", 10);
        EXPECT_EQ(agent.read_line(10), "done");
        agent.finish(0.2);
      }
    }
    ASSERT_EQ(helpers().size(), 2u) << end;
    for (const int number : helpers()) EXPECT_NE(kill(number, 0), 0) << end << ": process " << number << " is left";
  }
}

TEST_F(SearchBench, ReplacesATableOnlyWhereItIsAsked) {
  std::filesystem::create_directories(folder_ / "out");
  write_file(folder_ / "out/table.csv", "mine");
  const Outcome outcome = run_rubble("bench search " + (folder_ / "m.lua") + " --seeds 2 --baseline random --quiet --out " + (folder_ / "out"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("table.csv: is there already (--force replaces it)"), std::string::npos) << outcome.err;
  EXPECT_EQ(read_file(folder_ / "out/table.csv"), "mine");
}

TEST_F(SearchBench, AnAgentThatDiesHasItsTableAndItsExitCode) {
  const Outcome outcome = search("--seeds 2 --agent 'exit 7'");
  EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("the agent failed, first with seed 2: the agent ended with exit code 7"), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.out.find("agent"), std::string::npos) << "its table is missing";
}

TEST_F(SearchBench, AnAgentThatStaysStillAndSaysItIsDoneHasASearchOfItsOwn) {
  const Outcome outcome = search("--seeds 2 --json --agent 'read a; read line; echo \"{\\\"done\\\": true}\"; cat >&2'");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json table = Json::parse(outcome.out, nullptr, false);
  EXPECT_EQ(value(table, 0, "found_share"), 0);
  EXPECT_EQ(value(table, 0, "path_m"), 0);
  EXPECT_NE(read_file(folder_ / "out/agent_2.log").find("\"type\":\"end\""), std::string::npos);
}

TEST_F(SearchBench, MistakesAreNamed) {
  const auto expect = [&](const std::string& options, const std::string& part) {
    const Outcome outcome = search(options);
    EXPECT_EQ(outcome.exit_code, 1) << options;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << part << " is not in\n" << outcome.err;
  };
  expect("--seeds 2", "--agent: no agent is given");
  expect("--seeds 2 --baseline clever", "--baseline: no such baseline");
  expect("--seeds two --baseline random", "--seeds");
  expect("--baseline random --set victims.count=0", "victims.count: there are no victims");
  expect("--seeds 2 --baseline random --set victims.radius=0.9", "no pile of these seeds has room");
}

TEST(SearchEpisodes, ReportsCountOnceWithinHalfAMetreAndAreLimited) {
  const ScratchFolder folder;
  const Settled settled = settle_with(folder, "easy", 2);
  const SearchWorld world(settled.mission, settled.pile, SearchRules(), 2);
  ASSERT_EQ(world.targets().size(), 2u);
  SearchEpisode episode(world, 1);
  EXPECT_EQ(episode.observation().reports_left, 4);
  const Vec3 trunk = world.targets()[0].victim.trunk;
  SearchAction action;
  action.reports = {trunk + Vec3{0, 0, 0.51}};
  episode.step(action);
  EXPECT_EQ(episode.score().found, 0);
  EXPECT_EQ(episode.score().false_reports, 1);
  action.reports = {trunk + Vec3{0, 0, 0.49}, trunk};  // the second is of one that is found
  episode.step(action);
  EXPECT_EQ(episode.score().found, 1);
  EXPECT_EQ(episode.score().false_reports, 1);
  EXPECT_EQ(episode.observation().reports_left, 1);
  action.reports = {{100, 0, 0}, world.targets()[1].victim.trunk};  // one too many
  episode.step(action);
  EXPECT_EQ(episode.score().found, 1);
  EXPECT_EQ(episode.score().false_reports, 2);
  EXPECT_FALSE(episode.over());
  action.reports = {}, action.done = true;
  episode.step(action);
  EXPECT_TRUE(episode.over());
}

TEST(SearchEpisodes, TheRobotStopsBeforeSurfacesAndSeesWarmthWhereVictimsAre) {
  const ScratchFolder folder;
  const Settled settled = settle_with(folder, "easy", 2);
  const SearchRules rules;
  const SearchWorld world(settled.mission, settled.pile, rules, 2);
  const std::vector<const TriangleMesh*> meshes = settled.mission.assets.finest_meshes();
  const PileQueries queries(settled.pile, meshes);
  SearchEpisode episode(world, 1);
  RandomStream random(1, "commands");
  int stopped = 0, pixels = 0, wrong = 0, seen_warm = 0;
  for (int i = 0; i < 300; ++i) {
    SearchAction action;
    action.command = {random.direction() * 5.0, random.uniform(-2, 2)};
    const Vec3 before = episode.observation().pose.position;
    episode.step(action);
    const SearchObservation& seen = episode.observation();
    EXPECT_GE(queries.clearance(seen.pose.position, 1), rules.radius - 1e-9);
    EXPECT_LE(distance(before, seen.pose.position), rules.speed * rules.period + 1e-9);
    stopped += seen.stopped;
    const Pose body = seen.pose.world_from_body();
    for (std::size_t p = 0; p < seen.depth.size(); p += 311) {
      const Vec3 along = body.rotation.rotate(world.rays().direction(p));
      const auto hit = queries.cast_ray(body.translation, along, rules.max_range);
      const bool warm = seen.thermal[p] > float(rules.ambient + 5);
      ++pixels, seen_warm += warm;
      const double depth = hit ? hit->distance * world.rays().cosine(p) : rules.max_range;
      wrong += warm != (hit && world.is_victim(hit->piece)) ||
               std::fabs(std::min(double(seen.depth[p]), rules.max_range) - std::min(depth, rules.max_range)) > 1e-3;
    }
  }
  EXPECT_GT(stopped, 0);
  EXPECT_GT(seen_warm, 0);
  EXPECT_LT(wrong, pixels / 200) << "more than pixels that graze an edge";
  EXPECT_EQ(episode.score().collisions, stopped);
  SearchAction bad;
  bad.command.velocity.x = std::nan("");
  EXPECT_THROW(episode.step(bad), InputError);
}

}  // namespace search_test
}  // namespace rubble::testing
