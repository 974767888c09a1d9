// The filters by name, for filter_format.cpp and export_format.cpp. Each is told of in its file.
#pragma once

#include "host/formats/filters/filter_format.hpp"

namespace gyrolog {

extern const FilterFormat ardupilot_ek3_format;
extern const FilterFormat gtsam_format;
extern const FilterFormat kalibr_format;
extern const FilterFormat openvins_format;
extern const FilterFormat orb_slam3_format;
extern const FilterFormat px4_ekf2_format;
extern const FilterFormat robot_localization_format;
extern const FilterFormat sensor_msgs_imu_format;
extern const FilterFormat vins_fusion_format;

}  // namespace gyrolog
