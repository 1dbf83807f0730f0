#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "node/file_writer.h"
#include "part.h"
#include "self_awareness/KeptDrift.h"
#include "self_awareness/core/evidence/limits/drift_samples.h"

namespace self_awareness {

/// Says how far what is heard has drifted from what was learned (docs/learn_more.md): of each
/// component, the largest share of its limits in each start of the robot, or day of one. Only what
/// was normal counts, by stretches as they are kept to learn from. It is kept in a file beside the
/// model, for other starts.
///
/// It belongs to the thread that judges; a thread of its own waits for the disk. Times are ROS
/// time [ns].
class DriftKeeper : public Part {
 public:
  /// What is judged.
  struct Judged {
    std::uint64_t model = 0;              ///< number over what its shares depend on
    std::vector<std::string> components;  ///< of the shares; empty: it has no limits
  };
  /// A component whose drift is told.
  struct Told {
    std::string component;
    std::string words;  ///< "/slam 52 % -> 78 % of its limit, evidence 4.1e+03"
  };

  /// @param run_id of the roscore; empty: not known
  /// @param robot_start when the robot was started: wall time [ns]
  DriftKeeper(std::string run_id, std::int64_t robot_start);
  DriftKeeper(const DriftKeeper&) = delete;
  DriftKeeper& operator=(const DriftKeeper&) = delete;

  /// Another model judges from now on. What the file beside it says of another content of it is
  /// forgotten. One that is damaged is named in the log, and is written anew.
  /// @param path of the model
  void setModel(const std::string& path, Judged judged);
  /// Takes in a window that has settled.
  /// @param shares the largest of a limit, by component
  void add(std::int64_t begin, std::int64_t end, const std::vector<double>& shares);
  /// What is judged of components has changed: all begins anew.
  void forget();
  void onStart(const Session& session, const std::string& path) override;
  void onVerdict(core::Verdict& verdict, ros1::Circumstances& circumstances) override;
  /// The stretch does not count.
  void onNotNormal(const std::string& /*why*/) override { normal_ = false; }
  /// Ends the stretch.
  void onCut(Cut /*why*/) override { endStretch(); }
  void onRobotStart(std::int64_t at) override;
  void onReport(MonitorState& state) override;
  /// Ends the stretch and waits for the disk.
  void finish() override;

  /// Whose drift is told, the one with most evidence first.
  const std::vector<Told>& told() const { return told_; }
  /// Why the file could not be written; empty: it could.
  std::string error() const { return writer_.report().error; }

 private:
  void endStretch();
  /// Goes on with the samples of a file that is of this model.
  void read();
  void restore(const self_awareness::KeptDrift& kept);
  void write();
  void tell();

  const Session* session_ = nullptr;  // that judges; null: none does yet
  std::string run_id_;
  std::int64_t robot_start_;
  std::string path_;  // of the file
  Judged judged_;
  core::evidence::DriftSamples samples_{0};
  std::optional<core::evidence::DriftSamples::Stretch> stretch_;  // none: it has not begun
  bool normal_ = true;                                            // the stretch, so far
  std::vector<Told> told_;
  std::set<std::string> logged_;  // components that the log has named
  FileWriter writer_;
};

}  // namespace self_awareness
