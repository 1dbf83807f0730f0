#include "core/evidence/watch/upstream.h"

#include <utility>

namespace self_awareness::core::evidence {

Upstream::Upstream(std::vector<std::string> components, std::shared_ptr<const SourceGraph> graph)
    : components_(std::move(components)), graph_(std::move(graph)) {}

bool Upstream::isUpstream(std::size_t from, std::size_t to) const {
  if (empty()) {
    return false;
  }
  if (edges_ != graph_->edges().size()) {
    upstream_ = graph_->upstream(components_);
    edges_ = graph_->edges().size();
  }
  return upstream_[from][to];
}

}  // namespace self_awareness::core::evidence
