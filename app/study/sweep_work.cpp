#include "app/study/sweep_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>

#include "app/study/sweep_table.h"
#include "devices/files/atomic_file.h"
#include "devices/files/session/hdf5_reading.h"
#include "devices/files/text_file.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;

constexpr const char* kNote = "sweep.key";
constexpr std::size_t kLongestNote = 1 << 13;  // [bytes]

// What a folder, or a block, says that it belongs to.
struct Belongs {
  std::uint64_t plan, build;
};

void check_same(const Belongs& found, const Belongs& own, const fs::path& file) {
  const auto refuse = [&](const char* what, std::uint64_t theirs, std::uint64_t mine) {
    throw FileError(fmt::format(
        "{}: made from another {} ({}); needed: {}. Take another --out, or remove that folder",
        file.string(), what, hex(theirs), hex(mine)));
  };
  if (found.plan != own.plan) refuse("plan, or other files that it names", found.plan, own.plan);
  if (found.build != own.build) {
    refuse("build of limpid, or on another kind of processor", found.build, own.build);
  }
}

std::string note_of(const Belongs& own, const fs::path& plan) {
  return fmt::format("plan {}\nbuild {}\nfrom {}\n", hex(own.plan), hex(own.build),
                     fs::weakly_canonical(plan).string());
}

// A block that was cut off is made again.
hdf5::File opened_if_whole(const fs::path& path) {
  try {
    return hdf5::open_to_read(path);
  } catch (const FileError&) {
    return {};
  }
}

}  // namespace

SweepFolder::SweepFolder(const SweepPlan& plan, fs::path dir)
    : plan_(plan), dir_(std::move(dir)), columns_(measured_columns(plan).size()) {
  const Belongs own{plan.key, build_digest()};
  const fs::path note = dir_ / kNote;
  if (fs::exists(note)) {
    const std::string said = read_text(note, kLongestNote);
    Belongs found{};
    if (std::sscanf(said.c_str(), "plan %lx\nbuild %lx", &found.plan, &found.build) != 2) {
      throw FileError(fmt::format("{}: is no note of a sweep", note.string()));
    }
    check_same(found, own, note);
    return;
  }
  std::error_code error;
  fs::create_directories(dir_ / "blocks", error);
  if (error) throw FileError(fmt::format("{}: {}", dir_.string(), error.message()));
  const std::string text = note_of(own, plan.file);
  write_atomically(note, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

fs::path SweepFolder::file(const SweepBlock& block) const {
  return dir_ / "blocks" / fmt::format("{:06d}.h5", block.number);
}

bool SweepFolder::there(const SweepBlock& block) const {
  std::error_code none;
  return fs::exists(file(block), none);
}

std::optional<std::vector<double>> SweepFolder::read(const SweepBlock& block) const {
  const fs::path path = file(block);
  if (!there(block)) return std::nullopt;
  const hdf5::Quiet quiet;
  const hdf5::File file = opened_if_whole(path);
  if (!file) return std::nullopt;
  std::vector<double> rows(block.size * columns_);
  try {
    check_same(
        {hdf5::read_count(file.get(), "plan", path), hdf5::read_count(file.get(), "build", path)},
        {plan_.key, build_digest()}, path);
  } catch (const FileError&) {
    if (H5Aexists(file.get(), "plan") > 0 && H5Aexists(file.get(), "build") > 0) throw;
    return std::nullopt;
  }
  hdf5::Dataset dataset;
  try {
    dataset = hdf5::open_dataset(file.get(), "/values", path);
  } catch (const FileError&) {
    return std::nullopt;
  }
  const hdf5::Dataspace space(H5Dget_space(dataset.get()));
  if (H5Sget_simple_extent_npoints(space.get()) != std::ssize(rows)) return std::nullopt;
  if (H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) < 0) {
    return std::nullopt;
  }
  return rows;
}

void SweepFolder::write(const SweepBlock& block, const std::vector<double>& rows) const {
  FileImage image(file(block));
  image.number(image.root(), "plan", plan_.key);
  image.number(image.root(), "build", build_digest());
  image.number(image.root(), "first", block.first);
  image.add("/values", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, block.size, columns_, rows.data());
  image.write();
}

fs::path plan_behind(const fs::path& dir) {
  std::error_code none;
  if (fs::is_regular_file(dir / kNote, none)) {
    const std::string said = read_text(dir / kNote, kLongestNote), word = "\nfrom ";
    const std::size_t at = said.find(word);
    fs::path plan = at == std::string::npos
                        ? ""
                        : said.substr(at + word.size(), said.find('\n', at + 1) - at - word.size());
    if (fs::is_directory(plan.parent_path(), none)) return plan;
  }
  return dir / "plan.toml";
}

namespace {

// Blocks that threads take one after the other.
class Team {
 public:
  Team(const SweepPlan& plan, const SweepRows& rows, const SweepFolder& folder,
       const std::atomic<bool>& stop, std::atomic<std::uint64_t>& done, const TakeBlock& take)
      : plan_(plan), rows_(rows), folder_(folder), stop_(stop), done_(done), take_(take) {}

  // False if stopped.
  bool work(const std::vector<std::uint64_t>& blocks, unsigned threads) {
    next_ = 0;
    {
      std::vector<std::jthread> all;
      const auto count = std::min<std::size_t>(threads, blocks.size());
      for (std::size_t i = 0; i < count; ++i) all.emplace_back([&] { work_on(blocks); });
    }
    if (failure_) std::rethrow_exception(failure_);
    return !stop_.load();
  }

 private:
  void work_on(const std::vector<std::uint64_t>& blocks) {
    try {
      for (std::size_t i = next_++; i < blocks.size(); i = next_++) {
        if (!do_block(blocks[i])) return;
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      over_ = true;
    }
  }

  bool do_block(std::uint64_t number) {
    const SweepBlock block = rows_.block(number);
    std::vector<double> values;
    if (auto found = folder_.read(block)) {
      values = *std::move(found);
      done_ += block.size;
    } else {
      for (std::uint64_t i = 0; i < block.size; ++i) {
        if (over_) return false;
        const auto one = measure_point(plan_, rows_.point(block.first + i), stop_);
        if (!one) return false;
        values.insert(values.end(), one->begin(), one->end());
        ++done_;
      }
      folder_.write(block, values);
    }
    const std::lock_guard lock(mutex_);
    if (take_) take_(number, values);
    return true;
  }

  const SweepPlan& plan_;
  const SweepRows& rows_;
  const SweepFolder& folder_;
  const std::atomic<bool>& stop_;
  std::atomic<std::uint64_t>& done_;
  const TakeBlock& take_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> over_{false};
  std::mutex mutex_;
  std::exception_ptr failure_;
};

}  // namespace

bool work_off(const SweepPlan& plan, const SweepRows& rows, const SweepFolder& folder,
              const SweepShare& share, const std::atomic<bool>& stop,
              std::atomic<std::uint64_t>& done, const TakeBlock& take) {
  const unsigned threads =
      share.threads > 0 ? share.threads : std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::uint64_t> own, others;
  const std::uint64_t begin = rows.first_block(), count = rows.blocks() - begin;
  // Each begins elsewhere with what others may be doing, too.
  const std::uint64_t from = count * share.shard / share.shards;
  for (std::uint64_t b = 0; b < count; ++b) {
    if ((begin + b) % share.shards == share.shard) own.push_back(begin + b);
    const std::uint64_t turned = begin + (b + from) % count;
    if (turned % share.shards != share.shard) others.push_back(turned);
  }
  Team team(plan, rows, folder, stop, done, take);
  return team.work(own, threads) && (!share.helps || team.work(others, threads));
}

std::uint64_t SweepBook::missing() const {
  return static_cast<std::uint64_t>(std::ranges::count(taken_, false));
}

void SweepBook::take(std::uint64_t block, const std::vector<double>& rows) {
  table_.take(table_.rows.block(block).first, rows);
  taken_[block] = true;
  if (told_) told_(block, rows);
}

std::uint64_t SweepBook::gather() {
  std::uint64_t found = 0;
  do {
    taken_.resize(table_.rows.blocks(), false);
    for (std::uint64_t b = 0; b < table_.rows.blocks(); ++b) {
      if (taken_[b]) continue;
      const auto rows = folder_.read(table_.rows.block(b));
      if (!rows) continue;
      take(b, *rows);
      found += table_.rows.block(b).size;
    }
  } while (missing() == 0 && table_.grow());
  return found;
}

void SweepBook::write() const {
  write_table(plan_, table_, folder_.table());
  if (csv_) write_table_csv(plan_, table_, folder_.path() / "table.csv");
}

}  // namespace limpid
