#pragma once

namespace gyrolog {

inline constexpr double standard_gravity_m_s2 = 9.80665;  // 3rd CGPM, 1901

}  // namespace gyrolog
