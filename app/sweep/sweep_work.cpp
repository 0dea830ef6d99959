#include "app/sweep/sweep_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <optional>

#include "app/base/in_parallel.h"
#include "app/sweep/sweep_table.h"
#include "devices/files/atomic_file.h"
#include "devices/files/session/hdf5_reading.h"
#include "devices/files/text_file.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;

constexpr const char* kNote = "sweep.key";
constexpr std::size_t kLongestNote = 1 << 13;  // [bytes]

// Digests of the plan and build of a folder, or a block.
struct Belongs {
  std::uint64_t plan, build;
};

void check_same(const Belongs& found, const Belongs& own, const fs::path& file) {
  const auto refuse = [&](const char* what, std::uint64_t theirs, std::uint64_t mine) {
    throw FileError(fmt::format(
        "{}: made from another {} ({}); needed: {}. Use another --out, or remove that folder",
        file.string(), what, hex(theirs), hex(mine)));
  };
  if (found.plan != own.plan)
    refuse("plan, or from another version of a file that the plan names", found.plan, own.plan);
  if (found.build != own.build) {
    refuse("build of limpid, or on another kind of processor", found.build, own.build);
  }
}

// Reads a folder's note; nothing if there is none.
std::optional<Belongs> belongs(const fs::path& note) {
  if (!fs::exists(note)) return std::nullopt;
  const std::string said = read_text(note, kLongestNote);
  Belongs found{};
  if (std::sscanf(said.c_str(), "plan %lx\nbuild %lx", &found.plan, &found.build) != 2) {
    throw FileError(fmt::format("{}: this file is no note of a sweep", note.string()));
  }
  return found;
}

std::string note_of(const Belongs& own, const fs::path& plan) {
  return fmt::format("plan {}\nbuild {}\nfrom {}\n", hex(own.plan), hex(own.build),
                     fs::weakly_canonical(plan).string());
}

// Empty for a block that was cut off, so that it is made again.
hdf5::File opened_if_whole(const fs::path& path) {
  try {
    return hdf5::open_to_read(path);
  } catch (const FileError&) {
    return {};
  }
}

// Flags that end the work on a block.
struct Ends {
  const std::atomic<bool>&stop, &over;
};

// Values of a block from the folder, or measured and written there; nothing if the work was ended.
std::optional<std::vector<double>> values_of(const SweepPlan& plan, const SweepFolder& folder,
                                             const SweepBlock& block, const Ends& ends,
                                             std::atomic<std::uint64_t>& done) {
  if (auto found = folder.read(block)) {
    done += block.size;
    return found;
  }
  std::vector<double> values;
  for (std::uint64_t i = 0; i < block.size; ++i) {
    if (ends.over) return std::nullopt;
    const auto one = measure_point(plan, block.first + i, ends.stop);
    if (!one) return std::nullopt;
    values.insert(values.end(), one->begin(), one->end());
    ++done;
  }
  folder.write(block, values);
  return values;
}

}  // namespace

std::uint64_t blocks_of(const SweepPlan& plan) {
  return (plan.points() + plan.block - 1) / plan.block;
}

SweepBlock block_of(const SweepPlan& plan, std::uint64_t number) {
  const std::uint64_t first = number * plan.block;
  return {number, first, std::min(plan.block, plan.points() - first)};
}

SweepFolder::SweepFolder(const SweepPlan& plan, fs::path dir)
    : plan_(plan), dir_(std::move(dir)), columns_(measured_columns(plan).size()) {
  const Belongs own{plan.key, build_digest()};
  const fs::path note = dir_ / kNote;
  const std::optional<Belongs> found = belongs(note);
  if (found) check_same(*found, own, note);
  std::error_code error;
  fs::create_directories(dir_ / "blocks", error);
  if (error) throw FileError(fmt::format("{}: {}", dir_.string(), error.message()));
  if (found) return;
  const std::string text = note_of(own, plan.file);
  write_atomically(note, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

void check_plan_of(const SweepPlan& plan, const fs::path& dir) {
  const fs::path note = dir / kNote;
  const std::optional<Belongs> found = belongs(note);
  if (found) check_same(*found, {plan.key, found->build}, note);
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

bool is_sweep_folder(const fs::path& dir) {
  std::error_code none;
  return fs::is_regular_file(dir / kNote, none);
}

fs::path plan_behind(const fs::path& dir) {
  if (is_sweep_folder(dir)) {
    std::error_code none;
    const std::string said = read_text(dir / kNote, kLongestNote), word = "\nfrom ";
    const std::size_t at = said.find(word);
    fs::path plan = at == std::string::npos
                        ? ""
                        : said.substr(at + word.size(), said.find('\n', at + 1) - at - word.size());
    if (fs::is_directory(plan.parent_path(), none)) return plan;
  }
  return dir / "plan.toml";
}

bool work_off(const SweepPlan& plan, const SweepFolder& folder, const SweepShare& share,
              const std::atomic<bool>& stop, std::atomic<std::uint64_t>& done,
              const TakeBlock& take) {
  std::vector<std::uint64_t> own, others;
  const std::uint64_t count = blocks_of(plan);
  // Each share begins elsewhere with blocks of others, which several may be doing at once.
  const std::uint64_t from = count * share.shard / share.shards;
  for (std::uint64_t b = 0; b < count; ++b) {
    if (b % share.shards == share.shard) own.push_back(b);
    const std::uint64_t turned = (b + from) % count;
    if (turned % share.shards != share.shard) others.push_back(turned);
  }
  std::mutex taking;
  const auto work = [&](const std::vector<std::uint64_t>& blocks) {
    in_parallel(blocks.size(), threads_for(share.threads),
                [&](std::size_t i, const std::atomic<bool>& over) {
                  const auto values =
                      values_of(plan, folder, block_of(plan, blocks[i]), {stop, over}, done);
                  if (!values) return false;
                  const std::lock_guard lock(taking);
                  if (take) take(blocks[i], *values);
                  return true;
                });
    return !stop.load();
  };
  return work(own) && (!share.helps || work(others));
}

void SweepBook::take(std::uint64_t block, const std::vector<double>& rows) {
  table_.take(block_of(plan_, block).first, rows);
  taken_[block] = true;
}

std::uint64_t SweepBook::gather() {
  std::uint64_t found = 0;
  for (std::uint64_t b = 0; b < taken_.size(); ++b) {
    if (taken_[b]) continue;
    const SweepBlock block = block_of(plan_, b);
    const auto rows = folder_.read(block);
    if (!rows) continue;
    take(b, *rows);
    found += block.size;
  }
  return found;
}

void TimedTable::write_if_time() {
  const auto began = Clock::now();
  if (began < next_) return;
  book_.write();
  wait(Clock::now() - began);
}

void TimedTable::wait(Clock::duration writing) {
  constexpr Clock::duration kBetweenTables = std::chrono::seconds(2);
  next_ = Clock::now() + std::max(kBetweenTables, 20 * writing);
}

void SweepBook::write() const {
  write_table(plan_, table_, folder_.table());
  if (csv_) write_table_csv(plan_, table_, folder_.path() / "table.csv");
}

}  // namespace limpid
