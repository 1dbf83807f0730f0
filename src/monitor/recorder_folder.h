#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace self_awareness {

/// Two names differ by this, since they tell milliseconds [ns].
constexpr std::int64_t kNameStep = 1000000;
/// Bytes of one; space on the disk is given in megabytes.
constexpr std::uint64_t kMegabyte = 1000000;

/// A time [ns since 1970] in the name of a file, by UTC and in milliseconds:
/// "2026-11-22-05-10-33.123". Names sort as the times do.
std::string timeInFileName(std::int64_t wall_time);

/// Removes the oldest files of a folder until the rest is within the bounds; the newest one stays.
/// @param names regular expression of their names, whose group is the time
/// @param kept path of a file that stays, however old it is; empty: there is none
/// @throw std::runtime_error if a file cannot be removed
void removeOldest(const std::string& folder, const std::string& names, std::size_t most_files,
                  std::uint64_t most_bytes, const std::string& kept = "");

/// The folder of the flight recorder's files, in which the oldest ones make room for new ones.
/// Other files in it are left alone.
class RecorderFolder {
 public:
  /// @param path a leading "~/" stands for the home folder, a leading "$ROS_HOME/" for where ROS
  /// keeps what it writes (~/.ros), a "$NAME" for the name of the monitor
  /// @param name full name of the monitor; its slashes become underscores
  /// @param most_files, most_bytes that the recorder's files may be in all; the newest one stays
  /// even if it alone is larger
  RecorderFolder(const std::string& path, const std::string& name, std::size_t most_files,
                 std::uint64_t most_bytes);

  /// Path of a file that does not exist yet: "alarm_2026-11-22-05-10-33.123.bag", or a millisecond
  /// or more later if there is one already.
  /// @param cause why it is written: alarm, dump or shutdown
  /// @param wall_time in UTC [ns since 1970]: names sort in the order in which they were given,
  /// whatever ROS time does
  std::string pathOf(const std::string& cause, std::int64_t wall_time) const;
  /// Path of the file that says what the alarm is. It has the monitor's name: others may have the
  /// same folder.
  std::string pathOfStandingAlarm() const { return path_ + "/" + name_ + ".alarm"; }
  /// Path of the file with the last incidents, named like that.
  std::string pathOfIncidents() const { return path_ + "/" + name_ + ".incidents"; }
  /// Creates the folder if it is not there.
  /// @throw std::runtime_error if it cannot be created
  void create() const;
  /// Removes the recorder's oldest files, as removeOldest().
  /// @param kept path of the file of an alarm that stands
  void makeRoom(const std::string& kept) const;

 private:
  std::string name_;  // of the monitor, as a part of a file's name
  std::string path_;
  std::size_t most_files_;
  std::uint64_t most_bytes_;
};

}  // namespace self_awareness
