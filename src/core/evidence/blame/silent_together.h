#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/evidence/channel/scorer.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/verdict/silent.h"
#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core::evidence {

/// Notices that all components fell silent, or all that run on one computer while others are
/// heard: not they are to blame, but what they share (docs/method.md, section 6).
class SilentTogether {
 public:
  /// @param graph that says on which computers sources run; may grow
  SilentTogether(std::shared_ptr<const Model> model, std::shared_ptr<const SourceGraph> graph);

  /// Looks at who is silent at the end of the window that the scorer closed last.
  /// @param shares of their limits that the tracks of the model have reached
  /// @param limits of the model's tracks
  /// @param strangers time since sources sent what the model does not know [ns]
  std::optional<Silent> find(const std::vector<double>& shares, const Limits& limits,
                             const Scorer& scorer,
                             const std::map<std::string, std::int64_t>& strangers) const;

 private:
  struct Component {
    bool seen = false;
    std::int64_t silence = 0;  // since its last event of any type [ns], once it was seen
    bool judged = false;
    bool silent = false;       // it should have spoken by now
    bool near = false;         // nearly for longer than it is allowed to
    std::int64_t longest = 0;  // gap that is usual of what it says most often [ns], once judged
  };
  /// Components with something in common: all, or those on one computer.
  struct Group {
    std::int64_t silence = std::numeric_limits<std::int64_t>::max();  // of all of them [ns]
    std::vector<std::size_t> judged;                                  // their indices

    void add(std::size_t index, const Component& component);
  };

  std::vector<Component> look(const std::vector<double>& shares, const Limits& limits,
                              const Scorer& scorer) const;
  /// Those of a group that fell silent together; empty: somebody is heard, or too few are near
  /// their limits. Who fell silent before is none of them, and does not speak against it.
  std::vector<std::size_t> together(const Group& group,
                                    const std::vector<Component>& components) const;

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const SourceGraph> graph_;
};

}  // namespace self_awareness::core::evidence
