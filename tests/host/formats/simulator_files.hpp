// Simulators' files with an imu sensor, as their own projects show them.
#pragma once

namespace gyrolog {

// PX4-gazebo-models, models/x500_base/model.sdf (deb89fc2c68b), without its other links and sensors: noise of
// an IIM42653, 0.05 deg/s.
inline constexpr const char* x500_sdf = R"(<?xml version="1.0" encoding="UTF-8"?>
<sdf version='1.9'>
  <model name='x500_base'>
    <link name="base_link">
      <inertial><mass>2.0</mass></inertial>
      <sensor name="air_pressure_sensor" type="air_pressure">
        <update_rate>50</update_rate>
      </sensor>
      <sensor name="imu_sensor" type="imu">
        <always_on>1</always_on>
        <update_rate>250</update_rate>
        <imu>
          <angular_velocity>
            <!-- 0.05 deg/s converted to rad/s -->
            <x>
              <noise type="gaussian">
                <mean>0.0</mean>
                <stddev>0.0008726646</stddev>
              </noise>
            </x>
            <y>
              <noise type="gaussian">
                <mean>0.0</mean>
                <stddev>0.0008726646</stddev>
              </noise>
            </y>
            <z>
              <noise type="gaussian">
                <mean>0.0</mean>
                <stddev>0.0008726646</stddev>
              </noise>
            </z>
          </angular_velocity>
          <linear_acceleration>
            <x><noise type="gaussian"><mean>0.0</mean><stddev>0.00637</stddev></noise></x>
          </linear_acceleration>
        </imu>
      </sensor>
    </link>
  </model>
</sdf>
)";

// Gazebo's tutorial on sensor noise, with the elements of SDF 1.7's noise.sdf that it does not show on y and
// z.
inline constexpr const char* tutorial_sdf = R"(<sdf version="1.7"><model name="robot">
  <link name="imu_link"><sensor name="imu" type="imu">
    <imu><angular_velocity>
      <x><noise type="gaussian"><mean>0.0</mean><stddev>2e-4</stddev>
         <bias_mean>0.0000075</bias_mean><bias_stddev>0.0000008</bias_stddev></noise></x>
      <y><noise type="gaussian_quantized"><mean>0.01</mean><stddev>3e-4</stddev>
         <dynamic_bias_stddev>4e-6</dynamic_bias_stddev>
         <dynamic_bias_correlation_time>400</dynamic_bias_correlation_time><precision>2e-4</precision></noise></y>
      <z><noise type="none"/></z>
    </angular_velocity></imu>
  </sensor></link></model></sdf>
)";

// PX4-SITL_gazebo-classic, models/iris/iris.sdf.
inline constexpr const char* iris_sdf = R"(<?xml version="1.0" ?>
<sdf version="1.6">
  <model name='iris'>
    <link name='base_link'/>
    <plugin name='gps_plugin' filename='libgazebo_gps_plugin.so'/>
    <plugin name='rotors_gazebo_imu_plugin' filename='libgazebo_imu_plugin.so'>
      <robotNamespace/>
      <linkName>/imu_link</linkName>
      <imuTopic>/imu</imuTopic>
      <gyroscopeNoiseDensity>0.00018665</gyroscopeNoiseDensity>
      <gyroscopeRandomWalk>3.8785e-05</gyroscopeRandomWalk>
      <gyroscopeBiasCorrelationTime>1000.0</gyroscopeBiasCorrelationTime>
      <gyroscopeTurnOnBiasSigma>0.0087</gyroscopeTurnOnBiasSigma>
      <accelerometerNoiseDensity>0.00186</accelerometerNoiseDensity>
      <accelerometerRandomWalk>0.006</accelerometerRandomWalk>
      <accelerometerBiasCorrelationTime>300.0</accelerometerBiasCorrelationTime>
      <accelerometerTurnOnBiasSigma>0.196</accelerometerTurnOnBiasSigma>
    </plugin>
  </model>
</sdf>
)";

// As rotors_description's macro writes it, without the elements for which the plugin has a value of its own.
inline constexpr const char* rotors_urdf = R"(<robot name="firefly">
  <gazebo>
    <plugin filename="librotors_gazebo_imu_plugin.so" name="rotors_gazebo_imu_plugin">
      <linkName>firefly/imu_link</linkName>
      <gyroscopeNoiseDensity>0.0003394</gyroscopeNoiseDensity>
    </plugin>
  </gazebo>
</robot>
)";

// MuJoCo, XML reference, sensor and gyro; delay and interval as of 3.5.0.
inline constexpr const char* robot_mjcf = R"(<mujoco model="robot">
  <option timestep="0.004"/>
  <worldbody>
    <body name="torso"><freejoint/><geom type="sphere" size=".1"/><site name="imu" pos="0 0 .1"/></body>
  </worldbody>
  <sensor>
    <accelerometer name="acc" site="imu" noise="0.01"/>
    <gyro name="body_gyro" site="imu" noise="5e-4" cutoff="34.9"/>
  </sensor>
</mujoco>
)";

// AirSim, docs/sensors.md (8d1dd26f529c), with numbers of AirLib/include/sensors/imu/ImuSimpleParams.hpp
// (006d4e2ac54f) other than its own.
inline constexpr const char* airsim_settings = R"({
    "SettingsVersion": 1.2,
    "SimMode": "Multirotor",
    "DefaultSensors": {
        "Barometer": {"SensorType": 1, "Enabled": true},
        "Imu": {
            "SensorType": 2,
            "Enabled": true,
            "AngularRandomWalk": 0.6,
            "GyroBiasStability": 9.2,
            "VelocityRandomWalk": 0.24
        }
    }
}
)";

// ethz-asl/kalibr, working_directory/imu.yaml (fbc813665534).
inline constexpr const char* kalibr_imu = R"(#Accelerometers
accelerometer_noise_density: 1.86e-03   #Noise density (continuous-time)
accelerometer_random_walk:   4.33e-04   #Bias random walk

#Gyroscopes
gyroscope_noise_density:     1.87e-04   #Noise density (continuous-time)
gyroscope_random_walk:       2.66e-05   #Bias random walk

rostopic:                    /imu0      #the IMU ROS topic
update_rate:                 500.0      #Hz (for discretization of the values above)

)";

// ethz-asl/kalibr, working_directory/imu-camera_imu.yaml (bb1fb545b3c5): what a calibration writes.
inline constexpr const char* kalibr_chain = R"(imu0:
  T_i_b:
  - [1.0, 0.0, 0.0, 0.0]
  - [0.0, 1.0, 0.0, 0.0]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  accelerometer_noise_density: 0.00186
  accelerometer_random_walk: 0.000433
  gyroscope_noise_density: 0.000187
  gyroscope_random_walk: 2.66e-05
  model: calibrated
  rostopic: /imu0
  time_offset: 0.0
  update_rate: 500.0
)";

}  // namespace gyrolog
