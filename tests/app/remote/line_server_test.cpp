// Clients on the socket, good and bad ones.
#include "app/remote/line_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temp_dir.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

// A client that waits for a few seconds at most.
class Peer {
 public:
  explicit Peer(const std::filesystem::path& path) : file_(socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.string().copy(address.sun_path, sizeof(address.sun_path) - 1);
    connected_ = connect(file_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0;
    const timeval longest{5, 0};
    setsockopt(file_, SOL_SOCKET, SO_RCVTIMEO, &longest, sizeof(longest));
    setsockopt(file_, SOL_SOCKET, SO_SNDTIMEO, &longest, sizeof(longest));
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  ~Peer() { hang_up(); }

  bool connected() const { return connected_; }
  void hang_up() {
    if (file_ >= 0) close(std::exchange(file_, -1));
  }
  void end_saying() const { shutdown(file_, SHUT_WR); }
  // Sends text; false if the server takes no more.
  bool say(std::string_view text) const {
    while (!text.empty()) {
      const ssize_t sent = send(file_, text.data(), text.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      text.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }
  // Next line without its end; empty if there is none.
  std::string line() {
    while (received_.find('\n') == std::string::npos) {
      std::array<char, 4096> bytes{};
      const ssize_t size = recv(file_, bytes.data(), bytes.size(), 0);
      if (size <= 0) return "";
      received_.append(bytes.data(), static_cast<std::size_t>(size));
    }
    const std::size_t end = received_.find('\n');
    std::string line = received_.substr(0, end);
    received_.erase(0, end + 1);
    return line;
  }

 private:
  int file_;
  bool connected_ = false;
  std::string received_;
};

class LineServerTest : public testing::Test {
 protected:
  std::optional<LineServer::Event> event() {
    server->wait_until(std::chrono::steady_clock::now() + 1min);
    return server->take();
  }
  void wait_for_clients(std::size_t count) const {
    test::until([&] { return server->clients() == count; });
    ASSERT_EQ(server->clients(), count);
  }

  void listen_for_cut() {
    server.reset();
    server = std::make_unique<LineServer>(
        path, [this](std::string_view line) { cut = cut || line == "cut"; });
  }
  bool cut_is_heard() const {
    return test::until([this] { return cut.load(); });
  }

  std::atomic<bool> cut{false};
  test::TempDir dir;
  std::filesystem::path path = dir / "sockets" / "a.control";
  std::atomic<int> heard{0};
  std::unique_ptr<LineServer> server =
      std::make_unique<LineServer>(path, [this](std::string_view) { ++heard; });
};

TEST_F(LineServerTest, TakesLinesAndAnswersThem) {
  Peer peer(path);
  ASSERT_TRUE(peer.say("one\n\n  \ntwo\nthr"));
  const auto one = event(), two = event();
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->line, "one");
  EXPECT_EQ(two->line, "two");
  server->answer(one->from, "1");
  server->answer(two->from, "2");
  EXPECT_EQ(peer.line(), "1");
  EXPECT_EQ(peer.line(), "2");
  ASSERT_TRUE(peer.say("ee\n"));
  EXPECT_EQ(event()->line, "three");
  EXPECT_EQ(heard, 3);
}

TEST_F(LineServerTest, IsForItsUserAlone) {
  struct stat is {};
  ASSERT_EQ(stat(path.c_str(), &is), 0);
  EXPECT_EQ(is.st_mode & 0777u, 0600u);
  ASSERT_EQ(stat(path.parent_path().c_str(), &is), 0);
  EXPECT_EQ(is.st_mode & 0777u, 0700u);
}

TEST_F(LineServerTest, SaysWhoHasTheNameAndTakesOverWhatIsLeft) {
  try {
    const LineServer second(path);
    FAIL() << "two have one name";
  } catch (const ListenError& e) {
    EXPECT_THAT(e.what(), HasSubstr(std::to_string(getpid())));
  }
  server.reset();
  EXPECT_FALSE(std::filesystem::exists(path));
  const int stale = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.string().copy(address.sun_path, sizeof(address.sun_path) - 1);
  ASSERT_EQ(bind(stale, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  close(stale);
  server = std::make_unique<LineServer>(path);
  EXPECT_TRUE(Peer(path).connected());
}

TEST_F(LineServerTest, RefusesALongLineAndEndsTheConnection) {
  Peer peer(path);
  const std::string longest(LineServer::kLongestLine, 'x');
  ASSERT_TRUE(peer.say(longest + "\n"));
  EXPECT_EQ(event()->line, longest);
  peer.say(longest + "x");
  EXPECT_THAT(peer.line(), HasSubstr("at most 65536 bytes"));
  EXPECT_EQ(peer.line(), "");
  EXPECT_EQ(event()->line, std::nullopt);
}

TEST_F(LineServerTest, TakesNoFurtherThanItsAnswersGo) {
  Peer peer(path);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(peer.say(std::to_string(i) + "\n"));
  for (std::size_t i = 0; i < LineServer::kMostUnanswered; ++i) {
    ASSERT_EQ(event()->line, std::to_string(i));
  }
  server->wait_until(std::chrono::steady_clock::now() + 50ms);
  ASSERT_EQ(server->take(), std::nullopt);
  server->answer(1, "0");
  EXPECT_EQ(event()->line, std::to_string(LineServer::kMostUnanswered));
}

TEST_F(LineServerTest, OffersNothingToOneThatDoesNotRead) {
  Peer peer(path);
  ASSERT_TRUE(peer.say("1\n"));
  const auto from = event()->from;
  const std::string line(10'000, 'x');
  int taken = 0;
  while (server->offer(from, line) && taken < 1000) ++taken;
  EXPECT_LT(taken, 200);  // the room of the server and the system's socket
  EXPECT_EQ(peer.line(), line);
}

TEST_F(LineServerTest, TakesNothingMoreOfOneThatDoesNotFetchItsAnswers) {
  Peer peer(path);
  std::size_t answered = 0;
  const std::string answer(20'000, 'x');
  peer.say("x\n");
  for (auto next = event(); next && answered < 500; next = server->take()) {
    server->answer(next->from, answer);
    ++answered;
    peer.say("x\n");
    server->wait_until(std::chrono::steady_clock::now() + 100ms);
  }
  EXPECT_LT(answered, 200u);
}

// A controller that never reads must be able to stop what it has started.
TEST_F(LineServerTest, HearsTheCutOfAClientThatHasNotFetched400Answers) {
  listen_for_cut();
  Peer peer(path);
  const std::string answer(2000, 'x');  // more in all than server and system keep
  for (int i = 0; i < 400; ++i) ASSERT_TRUE(peer.say("get\n"));
  while (true) {
    server->wait_until(std::chrono::steady_clock::now() + 100ms);
    const auto each = server->take();
    if (!each) break;
    server->answer(each->from, answer);
  }
  ASSERT_TRUE(peer.say("cut\n"));
  EXPECT_TRUE(cut_is_heard());
}

TEST_F(LineServerTest, HearsTheCutBehindSixteenLinesThatNobodyHasAnswered) {
  listen_for_cut();
  Peer peer(path);
  for (std::size_t i = 0; i < LineServer::kMostUnanswered; ++i) {
    ASSERT_TRUE(peer.say("set\n"));
    ASSERT_EQ(event()->line, "set");
  }
  ASSERT_TRUE(peer.say("cut\n"));
  EXPECT_TRUE(cut_is_heard());
}

// Otherwise a program could fill the memory, or be kept from saying more.
TEST_F(LineServerTest, DropsLinesThatFindNoRoomCountsThemAndHearsTheCutAmongThem) {
  listen_for_cut();
  Peer peer(path);
  const std::string line(1023, 'x');
  const std::size_t kept = LineServer::kMostWaiting / 1024, more = 50;
  const std::size_t taken = LineServer::kMostUnanswered;
  for (std::size_t i = 0; i < taken + kept + more; ++i) ASSERT_TRUE(peer.say(line + "\n"));
  ASSERT_TRUE(peer.say("cut\n"));
  ASSERT_TRUE(cut_is_heard());
  std::size_t answered = 0;
  for (auto each = event(); answered < taken + kept; each = event()) {
    ASSERT_TRUE(each && each->line == line) << answered;
    server->answer(each->from, "ok");
    if (++answered == taken + kept) break;
  }
  std::string told;
  for (std::size_t i = 0; i < answered + 1; ++i) {
    if (const std::string each = peer.line(); each != "ok") told += each;
  }
  EXPECT_THAT(told, HasSubstr("51 lines were dropped"));
}

TEST_F(LineServerTest, TakesTheLastLineOfOneThatHasHungUp) {
  Peer peer(path);
  ASSERT_TRUE(peer.say("last\n"));
  peer.hang_up();
  EXPECT_EQ(event()->line, "last");
  EXPECT_EQ(event()->line, std::nullopt);
}

TEST_F(LineServerTest, TakesAllThatOneHasSaidBeforeItHungUp) {
  Peer peer(path);
  constexpr int kLines = 12;  // more than is read at once
  std::string all;
  for (int i = 0; i < kLines; ++i) all += std::string(4000, static_cast<char>('a' + i)) + "\n";
  ASSERT_TRUE(peer.say(all));
  peer.hang_up();
  for (int i = 0; i < kLines; ++i) {
    const auto each = event();
    ASSERT_TRUE(each && each->line) << i;
    EXPECT_EQ((*each->line)[0], 'a' + i);
  }
  EXPECT_EQ(event()->line, std::nullopt);
}

TEST_F(LineServerTest, AnswersOneThatSaysNothingMore) {
  Peer peer(path);
  ASSERT_TRUE(peer.say("last\n"));
  peer.end_saying();
  const auto last = event();
  server->answer(last->from, "yes");
  EXPECT_EQ(peer.line(), "yes");
  EXPECT_EQ(peer.line(), "");
}

TEST_F(LineServerTest, PartsFromAClientOnceItHasItsAnswer) {
  Peer peer(path);
  ASSERT_TRUE(peer.say("bye\n"));
  const auto bye = event();
  server->answer(bye->from, "ok");
  server->part_from(bye->from);
  EXPECT_EQ(peer.line(), "ok");
  EXPECT_EQ(peer.line(), "");
  wait_for_clients(0);
}

TEST_F(LineServerTest, HasRoomForSixteen) {
  std::vector<std::unique_ptr<Peer>> peers;
  for (std::size_t i = 0; i < LineServer::kMostClients; ++i) {
    peers.push_back(std::make_unique<Peer>(path));
    wait_for_clients(i + 1);
  }
  Peer another(path);
  EXPECT_THAT(another.line(), HasSubstr("16 programs are connected already"));
  EXPECT_EQ(another.line(), "");
  peers.pop_back();
  wait_for_clients(LineServer::kMostClients - 1);
  Peer next(path);
  ASSERT_TRUE(next.say("hello\n"));
  for (auto each = event(); each; each = event()) {
    if (each->line) {
      EXPECT_EQ(each->line, "hello");
      break;
    }
  }
}

TEST(ControlPath, IsInTheUsersRuntimeFolderAndHasAPlainName) {
  setenv("XDG_RUNTIME_DIR", "/run/user/1", 1);
  EXPECT_EQ(control_path("control"), "/run/user/1/limpid/control.control");
  for (const char* name : {"", "a/b", "..", "a b", "\xC3\xA4"}) {
    EXPECT_THROW(control_path(name), ListenError) << name;
  }
  EXPECT_THROW(control_path(std::string(65, 'a')), ListenError);
  setenv("XDG_RUNTIME_DIR", "relative", 1);
  EXPECT_THROW(control_path("control"), ListenError);
  unsetenv("XDG_RUNTIME_DIR");
  EXPECT_THROW(control_path("control"), ListenError);
}

TEST(ControlSocket, CanBeConnectedToFromWhenItIsSeen) {
  const test::TempDir dir;
  const std::filesystem::path path = dir / "a.control";
  for (int i = 0; i < 300; ++i) {
    std::atomic<bool> waits = false;
    auto seen = std::async(std::launch::async, [&] {
      waits = true;
      while (!std::filesystem::exists(path)) {
      }
      return Peer(path).connected();
    });
    while (!waits) std::this_thread::yield();
    const ControlSocket socket(path);
    ASSERT_TRUE(seen.get()) << i;
  }
  std::vector<std::string> left;
  for (const auto& entry : std::filesystem::directory_iterator(path.parent_path())) {
    left.push_back(entry.path().filename());
  }
  EXPECT_THAT(left, testing::ElementsAre("a.control.lock"));
}

TEST(ControlSocket, RefusesAFolderThatIsALink) {
  const test::TempDir dir;
  std::filesystem::create_directory(dir / "real");
  std::filesystem::create_symlink(dir / "real", dir / "link");
  EXPECT_THROW(ControlSocket(dir / "link" / "a.control"), ListenError);
}

}  // namespace
}  // namespace limpid
