#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>

namespace tissue {

/// How far a long computation has come.
struct Progress {
  const char* stage = "";
  /// Of the whole, from 0 to 1.
  double fraction = 0.0;
  /// Tets that the mesh has by now, or will have as far as is known.
  std::uint64_t tetrahedra = 0;
};

/// How a long computation runs: on how many threads, who hears of its progress, and whether it
/// shall go on.
struct Run {
  /// 0 means all that the machine has. No result depends on it.
  int threads = 0;
  /// Called by the thread that computes, a few times.
  std::function<void(const Progress&)> report = {};
  /// Set it from any thread to stop the computation.
  std::shared_ptr<std::atomic<bool>> cancelled = {};

  /// Throws InputError E_CANCELLED once `cancelled` is set. Loops ask often.
  void go_on() const;
  /// Reports and asks.
  void enter(const Progress& progress) const;
};

}  // namespace tissue
