#pragma once

namespace tissue {

/// How the closed form of the paper (Eqs. 7 to 12) spreads a displacement of one vertex.
struct PushOptions {
  /// R [m]: vertices nearer than this to the target move.
  double range = 0.03;
  /// Harder tissue moves less. Without it every density counts as the same (Eq. 8 alone).
  bool density_response = true;
  /// ρ_ref; 0: the median density within R.
  double reference_density = 0.0;
  /// The response t²/(2ρ) as printed, which grows with time and does not meet the tool.
  bool literal = false;
};

}  // namespace tissue
