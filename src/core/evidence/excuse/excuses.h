#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/evidence/excuse/excuse.h"
#include "self_awareness/core/evidence/channel/model.h"
#include "self_awareness/core/verdict/source_graph.h"

namespace self_awareness::core::evidence {

/// All excuses, and the one rule for them (docs/method.md, section 6.1): an excuse covers what
/// began since it holds, as beganSince() says.
class Excuses {
 public:
  using List = std::vector<std::unique_ptr<Excuse>>;

  Excuses(std::shared_ptr<const Model> model, List list)
      : model_(std::move(model)), list_(std::move(list)) {}

  /// Excuses what is unusual in a window.
  /// @param window whose excesses these are: it sees their excuses
  /// @param judgement as Excuse::closeWindow()
  void closeWindow(std::vector<Excess>& excesses, const Unusual& window, Judgement& judgement);
  void accept(const Acceptances& accepted);
  void restart();

 private:
  std::shared_ptr<const Model> model_;
  List list_;
};

/// The excuses that there are.
/// @param graph that says on which computers sources run; may grow
Excuses::List allExcuses(const std::shared_ptr<const Model>& model,
                         const std::shared_ptr<const SourceGraph>& graph);

}  // namespace self_awareness::core::evidence
