#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/evidence/explain/excess.h"
#include "core/evidence/watch/upstream.h"
#include "self_awareness/core/evidence/channel/model.h"

namespace self_awareness::core::evidence {

/// Says with whom it began, where something is wrong with two components: who is upstream of the
/// other one, or, as long as nobody knows who hears whom, who is followed by it as usual
/// (docs/method.md, section 6.2). Components are told by their numbers in the model.
class Causes {
 public:
  /// @param upstream may be empty: only what usually follows what then says who is the root
  Causes(std::shared_ptr<const Model> model, std::shared_ptr<const Upstream> upstream);

  /// Takes in a window.
  /// @param excesses all that is unusual, kept until the next one: who does not follow as usual is
  /// not led
  void closeWindow(const std::vector<Excess>& excesses) {
    excesses_ = &excesses;
    leads_.reset();
  }
  /// Whether nobody knows who hears whom.
  bool areGuessed() const { return upstream_->empty(); }
  /// Whether what is wrong with both of two components more likely began with the first one.
  bool isUpstream(std::size_t from, std::size_t to) const {
    return upstream_->isUpstream(from, to);
  }
  /// The same; where the graph does not say, by who follows whom.
  bool isRoot(std::size_t from, std::size_t to) const {
    return isUpstream(from, to) || (!isUpstream(to, from) && leads().count({from, to}) > 0);
  }
  /// Who gets messages of a component, or, where nobody knows who hears whom, follows it, or who
  /// does; by the number of the component.
  std::vector<bool> downstreamOf(std::size_t component) const;

 private:
  /// Pairs of which the second follows the first, and does so as usual.
  using Leads = std::set<std::pair<std::size_t, std::size_t>>;

  bool follows(const Track& track) const;
  const Leads& leads() const;

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Upstream> upstream_;
  std::vector<bool> follows_;  // whether `to` usually comes soon after `from`, by track
  const std::vector<Excess>* excesses_ = nullptr;  // of the last window
  mutable std::optional<Leads> leads_;             // in it, once somebody has asked
};

/// Orders things so that roots come before their victims. Root before victim is no total order:
/// what has the fewest roots among the remaining ones is next.
/// @param number of them, the likeliest first: they break ties
/// @param is_root whether what is wrong with the second of two comes from the first
/// @return their places, roots first
std::vector<std::size_t> rootFirst(std::size_t number,
                                   const std::function<bool(std::size_t, std::size_t)>& is_root);

}  // namespace self_awareness::core::evidence
