#pragma once

#include "tissue/simulate/scene.h"

namespace tissue {

/// When a tool takes hold and lets go. One without a jaw takes hold of the first that it touches.
class Jaw {
 public:
  enum class Act { kNothing, kTake, kRelease };

  Act act(const std::optional<ToolPose>& pose, bool holds_something) {
    const bool closed = pose && pose->closed.value_or(true);
    const bool just_closed = closed && !was_closed_;
    was_closed_ = closed;
    if (!closed) return holds_something ? Act::kRelease : Act::kNothing;
    // A jaw that was closed all along does not take hold of what it passes.
    if (holds_something || (pose->closed && !just_closed)) return Act::kNothing;
    return Act::kTake;
  }

 private:
  bool was_closed_ = false;
};

}  // namespace tissue
