// Transfer from limpid-session to limpid: the same numbers arrive, and a program taken over by a
// hostile file achieves no more than an error.
#include <sys/mman.h>
#include <unistd.h>

#include <bit>
#include <limits>

#include "core/base/descriptor.h"
#include "core/tick/parameters.h"
#include "devices/files/session/session_program.h"
#include "devices/files/session/session_reader.h"
#include "tests/devices/files/session/sample_session.h"
#include "tests/devices/files/test_files.h"

namespace limpid {
namespace {

using test::refusal;
using testing::HasSubstr;
using wire::Broken;

constexpr std::uint64_t kPlenty = 1 << 24;

class SessionWire : public testing::Test {
 protected:
  SessionWire() {
    session_.info = test::sample_info();
    session_.layout = RowLayout(3);
    const std::vector<double> sample = test::sample_rows(session_.layout, 0, 40);
    session_.rows.assign(sample.begin(), sample.end());
    session_.info.slides = {false, true, false};
    session_.changes = {{3, "coupling.k_vc = 8"}, {40, ""}};
    Session twin = session_;
    twin.info.config = "coupling.eta = 0.25\n";
    twin.rows[1] = -0.0;
    Session third = twin;
    third.info.config = "coupling.eta = 0.5\n";
    third.rows[2] = -7;
    third.changes.clear();
    session_.info.beside = {twin.info.config, third.info.config};
    session_.beside = {std::move(twin), std::move(third)};
    session_.marks = {{0, "first"}, {39, "\xCE\xB7 last"}};
  }

  void put(const Session& session) {
    wire::Writer to(*file_);
    put_session(to, session);
  }
  Session take(std::uint64_t most = kPlenty) {
    lseek(*file_, 0, SEEK_SET);
    wire::Reader from(*file_, most);
    return take_session(from);
  }
  off_t size() { return lseek(*file_, 0, SEEK_END); }
  void write(off_t at, std::uint64_t number) {
    ASSERT_EQ(pwrite(*file_, &number, sizeof number, at), static_cast<ssize_t>(sizeof number));
  }

  Session session_;
  const Descriptor file_{memfd_create("answer", MFD_CLOEXEC)};
};

void expect_same_bits(std::span<const double> a, std::span<const double> b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint64_t>(a[i]), std::bit_cast<std::uint64_t>(b[i])) << i;
  }
}

TEST_F(SessionWire, CarriesEverything) {
  put(session_);
  const Session back = take();
  EXPECT_EQ(back.info.tick, session_.info.tick);
  EXPECT_EQ(back.info.dof, 3);
  EXPECT_EQ(back.info.seed, session_.info.seed);
  for (const auto text : {&SessionInfo::created, &SessionInfo::app_version, &SessionInfo::build,
                          &SessionInfo::source, &SessionInfo::config, &SessionInfo::safety,
                          &SessionInfo::device_urdf, &SessionInfo::scene}) {
    EXPECT_EQ(back.info.*text, session_.info.*text);
  }
  ASSERT_EQ(back.info.models.size(), 1u);
  EXPECT_EQ(*back.info.models.begin()->second, *session_.info.models.begin()->second);
  EXPECT_EQ(back.info.models.begin()->first, session_.info.models.begin()->first);
  EXPECT_EQ(back.info.slides, session_.info.slides);
  expect_same_bits(back.rows, session_.rows);
  ASSERT_EQ(back.changes.size(), 2u);
  EXPECT_EQ(back.changes[0].row, 3u);
  EXPECT_EQ(back.changes[0].setting, "coupling.k_vc = 8");
  EXPECT_EQ(back.marks, session_.marks);
  ASSERT_EQ(back.lanes(), 3u);
  EXPECT_EQ(back.info.beside, session_.info.beside);
  for (const std::size_t lane : {1, 2}) {
    expect_same_bits(back.lane(lane).rows, session_.lane(lane).rows);
    EXPECT_EQ(back.lane(lane).info.config, session_.info.beside[lane - 1]);
    EXPECT_TRUE(back.lane(lane).info.beside.empty());
    EXPECT_EQ(back.lane(lane).changes.size(), lane == 1 ? 2u : 0u);
  }
}

// A leftover claims rows that are not whole; its changes are told before that is known.
TEST_F(SessionWire, LosesTheChangesAtRowsThatALeftoverHasLost) {
  session_.marks.clear();
  session_.changes = {{3, "coupling.k_vc = 8"}, {30, "coupling.k_vc = 9"}};
  wire::Writer to(*file_);
  put_about(to, session_, 40);
  const std::size_t whole = 30 * static_cast<std::size_t>(session_.layout.stride());
  std::vector<std::span<const double>> rows = session_.lane_rows();
  for (std::span<const double>& lane : rows) lane = lane.first(whole);
  put_rows(to, rows);
  put_rest(to, session_);
  const Session back = take();
  EXPECT_EQ(back.size(), 30u);
  ASSERT_EQ(back.changes.size(), 1u);
  EXPECT_EQ(back.changes[0].row, 3u);
  ASSERT_EQ(back.lane(kTwinLane).changes.size(), 1u) << "the other change of the twin is at row 40";
}

TEST_F(SessionWire, ThatIsCutOffAnywhereIsNoSession) {
  session_.info.device_urdf = "u";
  put(session_);
  for (off_t end = size() - 1; end >= 0; --end) {
    ASSERT_EQ(ftruncate(*file_, end), 0);
    EXPECT_THROW(take(), Broken) << end;
  }
}

TEST_F(SessionWire, TakesNoMemoryForWhatIsOnlyClaimed) {
  put(session_);
  const off_t first_text = sizeof(double) + sizeof(int) + sizeof(std::uint64_t);
  for (const std::uint64_t claim :
       {std::uint64_t{1} << 62, std::numeric_limits<std::uint64_t>::max(), kPlenty + 1}) {
    write(first_text, claim);
    EXPECT_THROW(take(), Broken) << claim;
  }
  EXPECT_THROW(take(100), Broken);
}

TEST_F(SessionWire, RefusesAnArmThatNobodyHas) {
  for (const int dof : {0, -1, kMaxDof + 1}) {
    Session session = session_;
    session.info.dof = dof;
    ASSERT_EQ(ftruncate(*file_, 0), 0);
    lseek(*file_, 0, SEEK_SET);
    put(session);
    EXPECT_THROW(take(), Broken) << dof;
  }
}

TEST_F(SessionWire, RefusesWhatDoesNotFitTogether) {
  const auto refused = [&](auto change) {
    Session session = session_;
    change(session);
    EXPECT_EQ(ftruncate(*file_, 0), 0);
    lseek(*file_, 0, SEEK_SET);
    put(session);
    EXPECT_THROW(take(), Broken);
  };
  refused([](Session& s) { s.rows.pop_back(); });
  refused([](Session& s) { s.changes[1].row = 41; });
  refused([](Session& s) { s.changes[1].row = 2; });
  refused([](Session& s) { s.marks[1].tick = 40; });
  refused([](Session& s) { s.info.slides.pop_back(); });
  refused([](Session& s) {
    s.rows.resize(s.rows.size() - static_cast<std::size_t>(s.layout.stride()));
    s.changes.pop_back();
  });
}

TEST_F(SessionWire, OfLawsThatThereAreNotIsRefused) {
  for (const double kind : {-1.0, double{kLaws}, std::nan("")}) {
    Session session = session_;
    session.layout.in(std::span(session.rows), Column::kind)[0] = kind;
    EXPECT_THAT(refusal([&] { check_rows(session, "a.h5"); }), HasSubstr("/coupling/kind")) << kind;
  }
}

TEST_F(SessionWire, CarriesATable) {
  const wire::Table table{{{"format", "limpid-sweep"}}, {{"points", 2}}, {{"/done", {1, 0}}}};
  wire::Writer to(*file_);
  put_table(to, table);
  lseek(*file_, 0, SEEK_SET);
  wire::Reader from(*file_, kPlenty);
  const wire::Table back = take_table(from);
  EXPECT_EQ(back.texts, table.texts);
  EXPECT_EQ(back.counts, table.counts);
  EXPECT_EQ(back.columns, table.columns);
  for (off_t end = size() - 1; end >= 0; --end) {
    ASSERT_EQ(ftruncate(*file_, end), 0);
    lseek(*file_, 0, SEEK_SET);
    wire::Reader cut(*file_, kPlenty);
    EXPECT_THROW(take_table(cut), Broken) << end;
  }
}

}  // namespace
}  // namespace limpid
