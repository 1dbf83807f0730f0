#pragma once

#include <dirent.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace self_awareness::ros1 {

/// The connections that others have made to this process's ports (slave API and TCPROS). roscpp
/// keeps each for as long as the other side likes, and reads whatever it sends: a thousand that
/// say nothing leave no file for anybody else, and one that sends a header without an end takes
/// all memory. Here such ones are closed.
///
/// Belongs to one thread. Times are steady [ns].
class Strangers {
 public:
  /// Opens three files, by which it can look when there is none left to open.
  Strangers();
  ~Strangers();
  Strangers(const Strangers&) = delete;
  Strangers& operator=(const Strangers&) = delete;

  /// So long may a connection be without being answered.
  static constexpr std::int64_t kPatience = 5000000000;
  /// So much may it send meanwhile [bytes].
  static constexpr std::uint64_t kMostUnanswered = 16000000;
  /// So many to the slave API may stay; the ones that said nothing for longest go first.
  static constexpr std::size_t kMost = 200;

  /// What has happened since the last look.
  struct Seen {
    bool called = false;  ///< the slave API: the master may have something to tell
    std::size_t closed = 0;
  };
  /// Looks at connections to these ports.
  /// @param now steady time [ns]
  Seen look(std::int64_t now, int slave_port, int data_port);

 private:
  struct Connection {
    std::int64_t since = 0;            // it was not answered
    std::uint64_t received = 0;        // in all [bytes]
    std::uint64_t sent = 0;            // in all [bytes]
    std::uint64_t received_until = 0;  // it was answered last [bytes]
  };

  class HeldFile;
  struct CloseFolder {
    void operator()(DIR* folder) const { closedir(folder); }
  };

  /// The numbers of all open files of this process.
  std::vector<int> openFiles();

  std::map<std::string, Connection> known_;  // by both ends
  std::unique_ptr<DIR, CloseFolder> folder_;
  std::unique_ptr<HeldFile> held_;
};

}  // namespace self_awareness::ros1
