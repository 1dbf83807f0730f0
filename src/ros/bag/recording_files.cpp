#include "recording_files.h"

#include <rosbag/exceptions.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include "open_bag.h"

namespace self_awareness::ros1 {
namespace {

using Place = std::pair<std::uint64_t, std::uint32_t>;  // chunk, and offset in it

Place placeOf(const BagIndexEntry& entry) {
  return {entry.chunk, entry.offset};
}

/// The messages that lie before all others in a file, on latched connections or such that name no
/// sender where others do: the recorder repeats there what was latched, and leaves out the sender.
std::vector<BagIndexEntry> leadingIn(const BagIndex& index) {
  const bool has_sources =
      std::any_of(index.connections.begin(), index.connections.end(),
                  [](const Connection& connection) { return !connection.callerid.empty(); });
  const auto may_be_repeated = [&](const Connection& connection) {
    return connection.latching || (has_sources && connection.callerid.empty());
  };
  if (std::none_of(index.connections.begin(), index.connections.end(), may_be_repeated)) {
    return {};
  }
  Place first_other(std::numeric_limits<std::uint64_t>::max(), 0);
  for (const BagIndexEntry& entry : index.entries) {
    if (!may_be_repeated(index.connections[entry.connection])) {
      first_other = std::min(first_other, placeOf(entry));
    }
  }
  std::vector<BagIndexEntry> leading;
  std::copy_if(index.entries.begin(), index.entries.end(), std::back_inserter(leading),
               [&](const BagIndexEntry& entry) { return placeOf(entry) < first_other; });
  return leading;
}

void leaveOut(const std::set<Place>& places, std::vector<BagIndexEntry>& entries) {
  if (places.empty()) {
    return;
  }
  entries.erase(
      std::remove_if(entries.begin(), entries.end(),
                     [&](const BagIndexEntry& entry) { return places.count(placeOf(entry)) > 0; }),
      entries.end());
}

}  // namespace

RecordingFiles::RecordingFiles(const std::vector<std::string>& paths,
                               const ChunkProgress& progress) {
  for (const std::string& path : paths) {
    add(path, openBag(path, progress));
  }
  // Who receives the messages has several threads, which may overtake each other at a split.
  if (!std::is_sorted(index_.entries.begin(), index_.entries.end(), Earlier())) {
    std::sort(index_.entries.begin(), index_.entries.end(), Earlier());
  }
  set_back_ = countOn(index_);
}

void RecordingFiles::add(const std::string& path, BagIndex index) {
  std::set<Place> repeated;
  std::set<Place> latched;  // that may be repeated
  for (const BagIndexEntry& entry : leadingIn(index)) {
    const bool is_nameless = index.connections[entry.connection].callerid.empty();
    (is_nameless ? repeated : latched).insert(placeOf(entry));
  }
  leaveOut(repeated, index.entries);
  repeated.clear();

  const std::vector<std::uint32_t> joined = join(index);
  std::vector<std::uint32_t> numbers(index_.connections.size());
  for (std::size_t i = 0; i < index.numbers.size(); ++i) {
    numbers[joined[i]] = index.numbers[i];
  }
  files_.push_back(
      {path, end_, index.entries.empty() ? 0 : index.entries.front().stamp, std::move(numbers)});
  for (BagIndexEntry& entry : index.entries) {
    const bool may_be_repeated = !latched.empty() && latched.count(placeOf(entry)) > 0;
    entry.chunk += files_.back().begin;
    entry.connection = joined[entry.connection];
    end_ = std::max(end_, entry.chunk + 1);
    if (may_be_repeated && isRepeated(entry)) {
      repeated.insert(placeOf(entry));
    }
  }
  leaveOut(repeated, index.entries);
  for (const BagIndexEntry& entry : index.entries) {
    if (index_.connections[entry.connection].latching) {
      last_latched_[entry.connection] = entry;
    }
  }
  index_.timeless += index.timeless;
  index_.by_python |= index.by_python;
  index_.recorded |= index.recorded;
  if (files_.size() == 1) {
    index_.numbers = files_.front().numbers;
    index_.entries = std::move(index.entries);
  } else {
    index_.entries.insert(index_.entries.end(), index.entries.begin(), index.entries.end());
  }
}

std::vector<std::uint32_t> RecordingFiles::join(const BagIndex& index) {
  // A node that connects again on a topic has two such connections, in each file.
  using Key = std::tuple<std::string, std::string, std::string, std::string, std::size_t>;
  const auto key_of = [](const Connection& connection, std::map<Key, std::size_t>& seen) {
    Key key{connection.topic, connection.callerid, connection.datatype, connection.md5sum, 0};
    std::get<4>(key) = seen[key]++;
    return key;
  };
  std::map<Key, std::size_t> seen;
  std::map<Key, std::uint32_t> known;
  for (std::uint32_t i = 0; i < index_.connections.size(); ++i) {
    known[key_of(index_.connections[i], seen)] = i;
  }
  seen.clear();
  std::vector<std::uint32_t> joined;
  for (const Connection& connection : index.connections) {
    const auto place = known.emplace(key_of(connection, seen),
                                     static_cast<std::uint32_t>(index_.connections.size()));
    if (place.second) {
      index_.connections.push_back(connection);
    }
    joined.push_back(place.first->second);
  }
  return joined;
}

bool RecordingFiles::isRepeated(const BagIndexEntry& entry) const {
  const auto before = last_latched_.find(entry.connection);
  if (before == last_latched_.end()) {
    return false;
  }
  Messages messages(*this);
  std::vector<std::uint8_t> first;
  std::vector<std::uint8_t> again;
  messages.read(before->second, first);
  messages.read(entry, again);
  return first == again;
}

std::vector<BagSummary::File> RecordingFiles::files() const {
  std::vector<BagSummary::File> files;
  for (const File& file : files_) {
    files.push_back({file.path, file.start});
  }
  return files;
}

template <typename Use>
auto RecordingFiles::Messages::inItsFile(const BagIndexEntry& entry, const Use& use) {
  const auto file = std::prev(
      std::upper_bound(files_.begin(), files_.end(), entry.chunk,
                       [](std::uint64_t chunk, const File& each) { return chunk < each.begin; }));
  const std::ptrdiff_t number = file - files_.begin();
  BagIndexEntry there = entry;
  there.chunk -= file->begin;
  try {
    auto opened = open_.find(number);
    if (opened == open_.end()) {
      open_.erase(open_.begin(), open_.lower_bound(number - 1));
      open_.erase(open_.upper_bound(number + 1), open_.end());
      opened = open_.try_emplace(number, file->path, file->numbers).first;
    }
    return use(opened->second, there);
  } catch (const rosbag::BagException& error) {
    throw BagError(file->path + ": a message cannot be read (" + error.what() + ")" +
                   reindexHint(file->path));
  } catch (const std::bad_alloc&) {
    throw BagError(file->path + ": the bag is damaged, or there is too little memory" +
                   reindexHint(file->path));
  }
}

void RecordingFiles::Messages::read(const BagIndexEntry& entry,
                                    std::vector<std::uint8_t>& content) {
  inItsFile(entry, [&](BagMessages& messages, const BagIndexEntry& there) {
    messages.read(there, content);
  });
}

core::Attributes RecordingFiles::Messages::attributes(const BagIndexEntry& entry,
                                                      AttributeReader& reader) {
  return inItsFile(entry, [&](BagMessages& messages, const BagIndexEntry& there) {
    return messages.attributes(there, reader);
  });
}

std::string nameOf(const std::vector<std::string>& paths) {
  if (paths.size() == 1) {
    return paths.front();
  }
  const std::string& last = paths.back();
  const std::size_t end = last.rfind(".bag");
  const std::size_t begin =
      end == std::string::npos ? end : last.find_last_not_of("0123456789", end - 1);
  return paths.front() + ".." +
         (begin == std::string::npos ? last : last.substr(begin + 1, end - begin - 1));
}

}  // namespace self_awareness::ros1
