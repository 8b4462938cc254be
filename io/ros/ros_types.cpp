// Names, sums and definitions of the messages: what makes a recording readable without ROS. The
// definitions are those of ROS's packages, less their comments; ROS 1 sums up fields, not comments.
#include "io/ros/ros_messages.h"

#define SECTION(type)                                                                            \
  "================================================================================\nMSG: " type \
  "\n"

#define POINT "float64 x\nfloat64 y\nfloat64 z\n"
#define QUATERNION \
  SECTION("geometry_msgs/Quaternion") "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
#define REGION                            \
  SECTION("sensor_msgs/RegionOfInterest") \
  "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n"
#define POSE                    \
  SECTION("geometry_msgs/Pose") \
  "Point position\nQuaternion orientation\n" SECTION("geometry_msgs/Point") POINT QUATERNION
#define TRANSFORM                    \
  SECTION("geometry_msgs/Transform") \
  "Vector3 translation\nQuaternion rotation\n" SECTION("geometry_msgs/Vector3") POINT QUATERNION

#define HEADER1 SECTION("std_msgs/Header") "uint32 seq\ntime stamp\nstring frame_id\n"
#define TIME2 SECTION("builtin_interfaces/Time") "int32 sec\nuint32 nanosec\n"
#define HEADER2 SECTION("std_msgs/Header") "builtin_interfaces/Time stamp\nstring frame_id\n" TIME2

// Fields that are the same in both.
#define IMAGE                                                                 \
  "uint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 " \
  "step\nuint8[] data\n"
#define COMPRESSED "string format\nuint8[] data\n"
#define CALIBRATION(d, k, r, p)                                                          \
  "uint32 height\nuint32 width\nstring distortion_model\nfloat64[] " d "\nfloat64[9] " k \
  "\nfloat64[9] " r "\nfloat64[12] " p                                                   \
  "\nuint32 binning_x\nuint32 binning_y\nRegionOfInterest roi\n"
#define INERTIAL                                                                     \
  "geometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"        \
  "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n" \
  "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n"
#define EVENTS "uint32 height\nuint32 width\nEvent[] events\n"
#define JOINTS "string[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n"
#define ODOMETRY                                                               \
  "string child_frame_id\ngeometry_msgs/PoseWithCovariance pose\ngeometry_msgs/" \
  "TwistWithCovariance twist\n"
#define POSE_COVARIANCE                                                                      \
  SECTION("geometry_msgs/PoseWithCovariance")                                                \
  "Pose pose\nfloat64[36] covariance\n" POSE SECTION("geometry_msgs/TwistWithCovariance")    \
  "Twist twist\nfloat64[36] covariance\n" SECTION("geometry_msgs/Twist")                     \
  "Vector3 linear\nVector3 angular\n" VECTOR
#define WRENCH SECTION("geometry_msgs/Wrench") "Vector3 force\nVector3 torque\n" VECTOR
#define CLOUD                                                                                  \
  "uint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\nuint32 point_step\n" \
  "uint32 row_step\nuint8[] data\nbool is_dense\n"
#define POINT_FIELD                                                                             \
  SECTION("sensor_msgs/PointField")                                                             \
  "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\n" \
  "uint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n"
#define SCAN                                                                                    \
  "float32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\nfloat32 time_increment\n"    \
  "float32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\nfloat32[] intensities\n"
#define VECTOR SECTION("geometry_msgs/Vector3") POINT

namespace rubble::ros {

const MessageType kClock{"rosgraph_msgs", "Clock", "a9c97c1d230cfc112e270351a944ee47",
                         "time clock\n", "builtin_interfaces/Time clock\n" TIME2};

const MessageType kString{"std_msgs", "String", "992ce8a1687cec8c8bd883ec73ca41d1", "string data\n",
                          "string data\n"};

const MessageType kImage{"sensor_msgs", "Image", "060021388200f6f0f447d0fcd9c64743",
                         "Header header\n" IMAGE HEADER1, "std_msgs/Header header\n" IMAGE HEADER2};

const MessageType kCompressedImage{
    "sensor_msgs", "CompressedImage", "8f7a12909da2c9d3332d540a0977563f",
    "Header header\n" COMPRESSED HEADER1, "std_msgs/Header header\n" COMPRESSED HEADER2};

const MessageType kCameraInfo{"sensor_msgs", "CameraInfo", "c9a58c1b0b154e0e6da7578cb991d214",
                              "Header header\n" CALIBRATION("D", "K", "R", "P") HEADER1 REGION,
                              "std_msgs/Header header\n" CALIBRATION("d", "k", "r", "p")
                                  HEADER2 REGION};

const MessageType kPoseStamped{"geometry_msgs", "PoseStamped", "d3812c3cbc69362b77dc0b19b345f8f5",
                               "Header header\nPose pose\n" HEADER1 POSE,
                               "std_msgs/Header header\nPose pose\n" HEADER2 POSE};

const MessageType kTfMessage{
    "tf2_msgs", "TFMessage", "94810edda583a504dfda3829e70d7eec",
    "geometry_msgs/TransformStamped[] transforms\n" SECTION("geometry_msgs/TransformStamped")
        "Header header\nstring child_frame_id\nTransform transform\n" HEADER1 TRANSFORM,
    "geometry_msgs/TransformStamped[] transforms\n" SECTION("geometry_msgs/TransformStamped")
        "std_msgs/Header header\nstring child_frame_id\nTransform transform\n" HEADER2 TRANSFORM};

const MessageType kImu{"sensor_msgs", "Imu", "6a62c6daae103f4ff57a132d6f95cec2",
                       "Header header\n" INERTIAL HEADER1 QUATERNION VECTOR,
                       "std_msgs/Header header\n" INERTIAL HEADER2 QUATERNION VECTOR};

const MessageType kJointState{"sensor_msgs", "JointState", "3066dcd76a6cfaef579bd0f34173e9fd",
                              "Header header\n" JOINTS HEADER1,
                              "std_msgs/Header header\n" JOINTS HEADER2};

const MessageType kOdometry{"nav_msgs", "Odometry", "cd5e73d190d741a2f92e81eda573aca7",
                            "Header header\n" ODOMETRY HEADER1 POSE_COVARIANCE,
                            "std_msgs/Header header\n" ODOMETRY HEADER2 POSE_COVARIANCE};

const MessageType kWrenchStamped{"geometry_msgs", "WrenchStamped", "d78d3cb249ce23087ade7e7d0c40cfa7",
                                 "Header header\nWrench wrench\n" HEADER1 WRENCH,
                                 "std_msgs/Header header\nWrench wrench\n" HEADER2 WRENCH};

const MessageType kPointCloud{"sensor_msgs", "PointCloud2", "1158d486dd51d683ce2f1be655c3c181",
                              "Header header\n" CLOUD HEADER1 POINT_FIELD,
                              "std_msgs/Header header\n" CLOUD HEADER2 POINT_FIELD};

const MessageType kLaserScan{"sensor_msgs", "LaserScan", "90c7ef2dc6895d81024acba2ac42f369",
                             "Header header\n" SCAN HEADER1, "std_msgs/Header header\n" SCAN HEADER2};

#define LIVOX "uint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\nCustomPoint[] points\n"
#define LIVOX_POINT                        \
  SECTION("livox_ros_driver2/CustomPoint") \
  "uint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\nuint8 reflectivity\nuint8 tag\nuint8 line\n"
const MessageType kLivoxScan{"livox_ros_driver2", "CustomMsg", "e4d6829bdfe657cb6c21a746c86b21a6",
                             "std_msgs/Header header\n" LIVOX HEADER1 LIVOX_POINT, "std_msgs/Header header\n" LIVOX HEADER2 LIVOX_POINT};

#define RANGE                                                                      \
  "uint8 ULTRASOUND=0\nuint8 INFRARED=1\nuint8 radiation_type\nfloat32 field_of_view\n" \
  "float32 min_range\nfloat32 max_range\nfloat32 range\n"
const MessageType kRange{"sensor_msgs", "Range", "c005c34273dc426c67a020a87bc24148",
                         "Header header\n" RANGE HEADER1, "std_msgs/Header header\n" RANGE HEADER2};

const MessageType kBool{"std_msgs", "Bool", "8b94c1b53db61fb6aed406028ad6332a", "bool data\n", "bool data\n"};

const MessageType kFluidPressure{"sensor_msgs", "FluidPressure", "804dc5cea1c5306d6a2eb80b9833befe",
                                 "Header header\nfloat64 fluid_pressure\nfloat64 variance\n" HEADER1,
                                 "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance\n" HEADER2};

#define MAGNETIC "geometry_msgs/Vector3 magnetic_field\nfloat64[9] magnetic_field_covariance\n"
const MessageType kMagneticField{"sensor_msgs", "MagneticField", "2f3b0b43eed0c9501de0fa3ff89a45aa",
                                 "Header header\n" MAGNETIC HEADER1 VECTOR, "std_msgs/Header header\n" MAGNETIC HEADER2 VECTOR};

// ROS 1 sums constants up with the blanks around their "=" as they stand in its files, but without those here.
#define FIX                                                                                              \
  "NavSatStatus status\nfloat64 latitude\nfloat64 longitude\nfloat64 altitude\n"                         \
  "float64[9] position_covariance\nuint8 COVARIANCE_TYPE_UNKNOWN=0\nuint8 COVARIANCE_TYPE_APPROXIMATED=1\n" \
  "uint8 COVARIANCE_TYPE_DIAGONAL_KNOWN=2\nuint8 COVARIANCE_TYPE_KNOWN=3\nuint8 position_covariance_type\n"
#define FIX_STATUS                                                                                     \
  SECTION("sensor_msgs/NavSatStatus")                                                                  \
  "int8 STATUS_NO_FIX=-1\nint8 STATUS_FIX=0\nint8 STATUS_SBAS_FIX=1\nint8 STATUS_GBAS_FIX=2\nint8 status\n" \
  "uint16 SERVICE_GPS=1\nuint16 SERVICE_GLONASS=2\nuint16 SERVICE_COMPASS=4\nuint16 SERVICE_GALILEO=8\nuint16 service\n"
const MessageType kNavSatFix{"sensor_msgs", "NavSatFix", "2d3a8cd499b9b4a0249fb98fd05cfa48",
                             "Header header\n" FIX HEADER1 FIX_STATUS, "std_msgs/Header header\n" FIX HEADER2 FIX_STATUS};

#define BATTERY_CONSTANTS \
  "uint8 POWER_SUPPLY_STATUS_UNKNOWN=0\nuint8 POWER_SUPPLY_STATUS_CHARGING=1\n" \
  "uint8 POWER_SUPPLY_STATUS_DISCHARGING=2\nuint8 POWER_SUPPLY_STATUS_NOT_CHARGING=3\n" \
  "uint8 POWER_SUPPLY_STATUS_FULL=4\nuint8 POWER_SUPPLY_HEALTH_UNKNOWN=0\nuint8 POWER_SUPPLY_HEALTH_GOOD=1\n" \
  "uint8 POWER_SUPPLY_HEALTH_OVERHEAT=2\nuint8 POWER_SUPPLY_HEALTH_DEAD=3\n" \
  "uint8 POWER_SUPPLY_HEALTH_OVERVOLTAGE=4\nuint8 POWER_SUPPLY_HEALTH_UNSPEC_FAILURE=5\n" \
  "uint8 POWER_SUPPLY_HEALTH_COLD=6\nuint8 POWER_SUPPLY_HEALTH_WATCHDOG_TIMER_EXPIRE=7\n" \
  "uint8 POWER_SUPPLY_HEALTH_SAFETY_TIMER_EXPIRE=8\nuint8 POWER_SUPPLY_TECHNOLOGY_UNKNOWN=0\n" \
  "uint8 POWER_SUPPLY_TECHNOLOGY_NIMH=1\nuint8 POWER_SUPPLY_TECHNOLOGY_LION=2\n" \
  "uint8 POWER_SUPPLY_TECHNOLOGY_LIPO=3\nuint8 POWER_SUPPLY_TECHNOLOGY_LIFE=4\n" \
  "uint8 POWER_SUPPLY_TECHNOLOGY_NICD=5\nuint8 POWER_SUPPLY_TECHNOLOGY_LIMN=6\n"
#define BATTERY \
  "float32 voltage\nfloat32 temperature\nfloat32 current\nfloat32 charge\nfloat32 capacity\n" \
  "float32 design_capacity\nfloat32 percentage\nuint8 power_supply_status\nuint8 power_supply_health\n" \
  "uint8 power_supply_technology\nbool present\nfloat32[] cell_voltage\nfloat32[] cell_temperature\n" \
  "string location\nstring serial_number\n"
const MessageType kBatteryState{"sensor_msgs", "BatteryState", "4ddae7f048e32fda22cac764685e3974",
                                BATTERY_CONSTANTS "Header header\n" BATTERY HEADER1,
                                BATTERY_CONSTANTS "std_msgs/Header header\n" BATTERY HEADER2};

const MessageType kEventArray{
    "dvs_msgs", "EventArray", "5e8beee5a6c107e504c2e78903c224b8",
    "Header header\n" EVENTS HEADER1 SECTION(
        "dvs_msgs/Event") "uint16 x\nuint16 y\ntime ts\nbool polarity\n",
    "std_msgs/Header header\n" EVENTS HEADER2 SECTION(
        "dvs_msgs/Event") "uint16 x\nuint16 y\nbuiltin_interfaces/Time ts\nbool polarity\n"};

}  // namespace rubble::ros
