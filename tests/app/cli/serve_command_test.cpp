// `limpid serve`: what programs open by name over its socket; and what a stopped command leaves.
#include <csignal>
#include <nlohmann/json.hpp>

#include "app/base/interrupt.h"
#include "devices/files/session/session.h"
#include "tests/app/cli/beside.h"
#include "tests/app/cli/said.h"
#include "tests/support/built_in.h"
#include "tests/support/line_client.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::Said;
using test::text_of;
using testing::AllOf;
using testing::ContainsRegex;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class ServeCommand : public test::Program {
 protected:
  ServeCommand() { interrupted = false; }
  ~ServeCommand() override { interrupted = false; }
  void serve(std::vector<std::string> words) {
    words.insert(words.begin(), {"serve", "lab"});
    serving_.emplace([this, words] {
      const Said said = run(words);
      write("said.txt", said.out + said.err);
      return said.status;
    });
    const fs::path socket = temp_ / "home/limpid/lab.control";
    ASSERT_TRUE(test::until([&] { return fs::exists(socket); }));
    client_.emplace(socket);
  }
  // Ends the command as a terminal does that is closed; returns what it said.
  std::string stop() {
    client_.reset();
    EXPECT_EQ(serving_->end(SIGTERM), 0);
    return text_of("said.txt");
  }
  json answer(const json& request) {
    client_->say(request.dump());
    std::optional<json> line;
    test::until([&] { return (line = client_->take()).has_value(); });
    return line.value_or(json());
  }
  json ask(const json& request) { return test::granted(answer(request)); }
  std::string no(const json& request) { return test::reason(answer(request)); }
  json state() { return ask({{"do", "get"}, {"keys", json::array()}})["state"]; }
  json setting(const std::string& key) {
    return ask({{"do", "get"}, {"keys", {key}}})["values"][key];
  }

 private:
  std::optional<test::Beside> serving_;
  std::optional<test::LineClient> client_;
};

TEST_F(ServeCommand, OpensFilesThatCameAlongByTheirNames) {
  ASSERT_NO_FATAL_FAILURE(serve({"--eta", "0.8"}));
  EXPECT_EQ(ask({{"do", "hello"}})["kind"], "serve");
  const json first = state();
  EXPECT_EQ(first["arm"], "omni");
  EXPECT_EQ(first["device"], false);
  EXPECT_EQ(first["scene"], test::omni_document("table.toml").title);
  EXPECT_EQ(first["hand"], nullptr) << "nobody holds it";
  EXPECT_EQ(setting("coupling.eta"), 0.8);

  ask({{"do", "set"}, {"values", {{"coupling.eta", 0.6}}}});
  EXPECT_EQ(ask({{"do", "open"}, {"scene", "stack.toml"}})["scene"],
            test::omni_document("stack.toml").title);
  EXPECT_EQ(setting("coupling.eta"), 0.6) << "the arm is the same";
  EXPECT_THAT(no({{"do", "open"}, {"scene", "stak.toml"}}),
              AllOf(StartsWith("open: scene: there is no file \"stak.toml\"; did you mean "
                               "stack.toml? allowed: a path that begins with /, or one of "),
                    HasSubstr("free.toml, "), Not(HasSubstr(".urdf"))));
  EXPECT_THAT(no({{"do", "open"}, {"arm", "nothing.at.all"}}),
              HasSubstr("open: arm: there is no file \"nothing.at.all\"; allowed: a path"));
  EXPECT_THAT(no({{"do", "open"}, {"scene", "/none.toml"}}), HasSubstr("/none.toml"));
  EXPECT_EQ(state()["scene"], test::omni_document("stack.toml").title) << "it goes on";

  const std::string own = temp_ / "own.toml";
  write("own.toml", "title = \"Mine\"\nabout = \"Nothing.\"\n");
  EXPECT_EQ(ask({{"do", "open"}, {"scene", own}})["scene"], "Mine");
  const json other = ask({{"do", "open"}, {"arm", "touch.urdf"}, {"scene", "table.toml"}});
  EXPECT_EQ(other["arm"], "touch");
  EXPECT_EQ(other["hand"], nullptr);
  EXPECT_EQ(setting("coupling.eta"), 0.8) << "as the command says";
  EXPECT_EQ(ask({{"do", "open"}, {"hand", "touch.csv"}})["arm"], "touch") << "as it is";
  EXPECT_THAT(state()["hand"]["source"].get<std::string>(), HasSubstr("touch.csv"));
  EXPECT_NEAR(state()["hand"]["duration"], test::hand("touch.csv").duration(), 1e-9);
  EXPECT_EQ(ask({{"do", "open"}, {"arm", "omni.urdf"}})["hand"], nullptr)
      << "a path of another arm's";
  const json session = ask({{"do", "open"}, {"session", "table.h5"}});
  EXPECT_EQ(session["arm"], "omni");
  EXPECT_GT(session["hand"]["duration"], 0.1);

  EXPECT_THAT(stop(),
              AllOf(StartsWith("limpid listens on "), EndsWith("/home/limpid/lab.control\n")));
  EXPECT_FALSE(fs::exists(temp_ / "home/limpid/lab.control"));
}

TEST_F(ServeCommand, LeadsTheHandThatItIsGivenAndDrawsAndRecords) {
  ASSERT_NO_FATAL_FAILURE(serve({"--hand", "touch.csv", "--scene", "table.toml"}));
  EXPECT_THAT(state()["hand"]["source"].get<std::string>(), HasSubstr("touch.csv"));
  const std::string picture = temp_ / "now.png";
  EXPECT_EQ(ask({{"do", "picture"}, {"file", picture}})["file"], picture);
  const std::string png = text_of(picture);
  ASSERT_GT(png.size(), 24u);
  EXPECT_THAT(png, StartsWith("\x89PNG"));
  EXPECT_EQ(png.substr(16, 8), std::string("\0\0\x05\0\0\0\x03\x20", 8)) << "1280 x 800";
  const std::string file = ask({{"do", "record"}})["file"];
  EXPECT_THAT(file, StartsWith((temp_ / "home/limpid/sessions/session-").string()));
  EXPECT_TRUE(test::until([&] { return state()["hand"]["time"] > 0.05; }));
  EXPECT_EQ(ask({{"do", "stop"}})["file"], file);
  EXPECT_GT(read_session(file).size(), 0u);
}

// Work that is stopped says so, ends with 1, and leaves no half of a file.
TEST_F(ServeCommand, StopsLikeAllCommandsWithOneLine) {
  write("plan.toml", R"(title = "Two"
scene = "free.toml"
hand = { at = [0.19, 0, 0], jump = [2e-4, 2e-4, 2e-4] }
seconds = 0.02
measure = ["stable"]
[[axis]]
key = "coupling.eta"
values = [0.5, 1]
)");
  interrupted = true;
  const Said ran = run({"run", "--duration", "5", "--record", "a.h5"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_THAT(ran.err, ContainsRegex("^limpid: stopped at [0-9.]+ s\n$"));
  EXPECT_THAT(ran.out, ContainsRegex("recorded [0-9]+ ticks in a.h5\n$"));
  EXPECT_FALSE(fs::exists("a.h5.part"));
  const Said swept = run({"sweep", "plan.toml", "--out", "swept"});
  EXPECT_EQ(swept.status, 1);
  EXPECT_EQ(swept.err, "limpid: stopped; the same command continues from here\n");
  EXPECT_EQ(swept.out, "");
  const Said shown = run({"sweep", "plan.toml", "--out", "swept", "--open", "1"});
  EXPECT_EQ(shown.status, 1);
  const Said tried = run({"experiment", "inertia", "--out", "tried"});
  EXPECT_EQ(tried.status, 1);
  EXPECT_EQ(tried.err, "limpid: stopped; the same command continues from here\n");
  EXPECT_FALSE(fs::exists("tried/inertia.csv"));
  const Said rated = run({"characterize", "omni.urdf", "--out", "rated"});
  EXPECT_EQ(rated.status, 1);
  EXPECT_EQ(rated.err, "limpid: stopped; no results were written\n");
  EXPECT_FALSE(fs::exists("rated/characterize.json"));
  const Said told = run({"story", "first.toml"});
  EXPECT_EQ(told.status, 1);
  EXPECT_THAT(told.err, ContainsRegex("limpid: stopped at [0-9.]+ of 47.0 s\n$"));
  const Said moved = run({"identify", "simulated", "--out", "moved"});
  EXPECT_EQ(moved.status, 1);
  EXPECT_THAT(moved.err, HasSubstr("; moved/motion.csv contains the motion up to that time\n"));
  interrupted = false;
  EXPECT_EQ(done({"sweep", "plan.toml", "--out", "swept"}), "2 of 2 points in swept/table.h5\n")
      << "it goes on";
}

}  // namespace
}  // namespace limpid
