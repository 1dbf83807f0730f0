#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core::evidence {

/// Says which components of a model are upstream of which others (SourceGraph::upstream), by
/// their numbers. To find out takes time on large robots, so it is done once, and again when the
/// graph has grown.
class Upstream {
 public:
  /// @param components of the model, each once: their places are their numbers
  /// @param graph who hears whom; may be empty, and may grow
  Upstream(std::vector<std::string> components, std::shared_ptr<const SourceGraph> graph);

  /// Whether it is not known who hears whom: nobody is upstream then.
  bool empty() const { return graph_->empty(); }
  /// Whether what is wrong with both of two components more likely began with the first one.
  bool isUpstream(std::size_t from, std::size_t to) const;

 private:
  std::vector<std::string> components_;
  std::shared_ptr<const SourceGraph> graph_;
  mutable std::vector<std::vector<bool>> upstream_;  // by both numbers
  mutable std::size_t edges_ = 0;                    // of the graph that this was found in
};

}  // namespace self_awareness::core::evidence
