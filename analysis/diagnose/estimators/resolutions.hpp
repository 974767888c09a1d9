// How finely the estimators look, where several of them look alike. Made finer, these change no answer.
#pragma once

namespace gyrolog::resolution {

// A gain of less, where a scan has its top, is not looked at more closely. What can be called has
// `decisions.seen_nats()` and more.
inline constexpr double worth_refining_nats = 1.0;
// Of the logarithm of a parameter: one that is known worse than this is not known at all, and the curvature
// says no more.
inline constexpr double sd_log_most = 3.0;
// The least step, in such a logarithm, over which a curvature is taken.
inline constexpr double step_log = 0.002;
// Of a variance: less is as good as nothing.
inline constexpr double negligible_share = 1e-3;

}  // namespace gyrolog::resolution
