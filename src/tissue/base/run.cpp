#include "tissue/base/run.h"

#include "tissue/base/error.h"

namespace tissue {

void Run::go_on() const {
  if (cancelled && cancelled->load(std::memory_order_relaxed)) {
    throw InputError(ErrorCode::kCancelled, "cancelled on request");
  }
}

void Run::enter(const Progress& progress) const {
  go_on();
  if (report) report(progress);
}

}  // namespace tissue
