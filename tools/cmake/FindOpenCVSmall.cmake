# OpenCV's core, imgproc and imgcodecs, as Debian's three small packages bring them. OpenCVConfig.cmake and opencv4.pc
# are only in libopencv-dev, which pulls in every module and a desktop's worth of libraries.
#
# Imported targets: OpenCVSmall::core, OpenCVSmall::imgproc, OpenCVSmall::imgcodecs. Their include folder is a system
# one, because OpenCV's headers warn.
find_path(OpenCVSmall_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4)
set(OpenCVSmall_parts core imgproc imgcodecs)
set(OpenCVSmall_needed OpenCVSmall_INCLUDE_DIR)
foreach(part IN LISTS OpenCVSmall_parts)
  find_library(OpenCVSmall_${part}_LIBRARY opencv_${part})
  list(APPEND OpenCVSmall_needed OpenCVSmall_${part}_LIBRARY)
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCVSmall REQUIRED_VARS ${OpenCVSmall_needed}
  REASON_FAILURE_MESSAGE "install libopencv-core-dev libopencv-imgproc-dev libopencv-imgcodecs-dev")
mark_as_advanced(${OpenCVSmall_needed})

if(OpenCVSmall_FOUND AND NOT TARGET OpenCVSmall::core)
  foreach(part IN LISTS OpenCVSmall_parts)
    add_library(OpenCVSmall::${part} UNKNOWN IMPORTED)
    set_target_properties(OpenCVSmall::${part} PROPERTIES IMPORTED_LOCATION "${OpenCVSmall_${part}_LIBRARY}"
      INTERFACE_INCLUDE_DIRECTORIES "${OpenCVSmall_INCLUDE_DIR}")
  endforeach()
  target_link_libraries(OpenCVSmall::imgproc INTERFACE OpenCVSmall::core)
  target_link_libraries(OpenCVSmall::imgcodecs INTERFACE OpenCVSmall::imgproc)
endif()
