#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "core/evidence/excuse/excuse.h"

namespace self_awareness::core::evidence {

/// The excuse that a simulation runs slower than in training: who keeps the time of the real world
/// sends more often by its clock, and several that have nothing to do with each other do so by the
/// same factor, while others go on as usual (docs/method.md, section 6.1). Only in simulated time.
class SlowerClock : public Excuse {
 public:
  explicit SlowerClock(std::shared_ptr<const Model> model) : model_(std::move(model)) {}

  Excused reason() const override { return Excused::kSlowerClock; }
  std::optional<std::int64_t> closeWindow(const Unusual& window, Judgement& judgement) override;
  /// What is unusual of who sends faster by the common factor.
  bool explains(const Excess& excess, const Unusual& window) const override;
  void restart() override;

 private:
  using ByComponent = std::map<std::size_t, Suspect>;

  /// Who sends faster, and by how much.
  ByComponent faster(const Unusual& window) const;
  /// Whether it is abnormal, none of them is why the others do so, and some are heard that do not.
  bool haveNoOtherReason(const ByComponent& faster, const Unusual& window) const;

  std::shared_ptr<const Model> model_;
  ByComponent faster_;                 // in the last window that it held in
  std::optional<std::int64_t> since_;  // that it is slower [ns]
  std::int64_t last_ = 0;              // time that two were faster [ns]
  std::size_t number_ = 0;             // of those that were
  Reason reason_;
};

}  // namespace self_awareness::core::evidence
