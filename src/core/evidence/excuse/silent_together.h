#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/evidence/excuse/excuse.h"
#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core::evidence {

/// The excuse that all fell silent at one moment, or all that run on one computer while others are
/// heard: it is what they share (docs/method.md, section 6.1).
class SilentTogether : public Excuse {
 public:
  /// @param graph that says on which computers sources run; may grow
  SilentTogether(std::shared_ptr<const Model> model, std::shared_ptr<const SourceGraph> graph)
      : model_(std::move(model)), graph_(std::move(graph)) {}

  Excused reason() const override { return Excused::kAllSilent; }
  std::optional<std::int64_t> closeWindow(const Unusual& window, Judgement& judgement) override;
  bool explains(const Excess& excess, const Unusual& window) const override;
  void restart() override { found_.reset(); }

 private:
  struct Component {
    std::optional<std::int64_t> silence;  // since its last event of any type [ns]
    bool judged = false;
    bool silent = false;       // it should have spoken by now
    bool near = false;         // nearly for longer than it is allowed to
    std::int64_t longest = 0;  // gap that is usual of what it says most often [ns], once judged
  };

  std::vector<Component> look(const Unusual& window) const;
  /// Those of some components that fell silent together; empty: somebody is heard, or too few are
  /// near their limits. Who fell silent before is none of them, and does not speak against it.
  /// @param silence of all of them [ns]
  std::vector<std::size_t> together(const std::vector<std::size_t>& group, std::int64_t silence,
                                    const std::vector<Component>& components,
                                    const Causes& causes) const;

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const SourceGraph> graph_;
  std::optional<Silent> found_;
};

}  // namespace self_awareness::core::evidence
