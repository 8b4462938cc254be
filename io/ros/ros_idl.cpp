#include "io/ros/ros_idl.h"

#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "io/ros/ros_messages.h"
#include "kernel/base/tables/text_table.h"

namespace rubble::ros {
namespace {

struct Field {
  std::string type, name;  // type: a primitive, or "package/kind/Name"
  std::string array;       // "[9]", "[]" or ""
};
struct Type {
  std::vector<Field> fields;
  bool written = false;
};
using Types = std::map<std::string, Type>;  // by "package/kind/Name"

const std::map<std::string_view, const char*> kPrimitives{
    {"bool", "boolean"},        {"uint8", "octet"},          {"byte", "octet"},   {"char", "octet"},
    {"int8", "int8"},           {"int16", "short"},          {"uint16", "unsigned short"},
    {"int32", "long"},          {"uint32", "unsigned long"}, {"int64", "long long"},
    {"uint64", "unsigned long long"}, {"float32", "float"},  {"float64", "double"}, {"string", "string"},
};

// Of messages that are heard alone, and of services: as in ROS's packages, without comments and constants.
struct Definition {
  const char *name, *fields;
};
const Definition kOthers[] = {
    {"builtin_interfaces/msg/Duration", "int32 sec\nuint32 nanosec\n"},
    {"geometry_msgs/msg/Twist", "Vector3 linear\nVector3 angular\n"},
    {"geometry_msgs/msg/Accel", "Vector3 linear\nVector3 angular\n"},
    {"sensor_msgs/msg/Joy", "std_msgs/Header header\nfloat32[] axes\nint32[] buttons\n"},
    {"trajectory_msgs/msg/JointTrajectoryPoint",
     "float64[] positions\nfloat64[] velocities\nfloat64[] accelerations\nfloat64[] effort\n"
     "builtin_interfaces/Duration time_from_start\n"},
    {"trajectory_msgs/msg/JointTrajectory", "std_msgs/Header header\nstring[] joint_names\nJointTrajectoryPoint[] points\n"},
    {"simulation_interfaces/msg/Result", "uint8 result\nstring error_message\n"},
    {"simulation_interfaces/msg/SimulationState", "uint8 state\n"},
    {"simulation_interfaces/msg/SimulatorFeatures", "uint16[] features\nstring[] spawn_formats\nstring custom_info\n"},
    {"simulation_interfaces/msg/Bounds", "uint8 type\ngeometry_msgs/Vector3[] points\n"},
    {"simulation_interfaces/msg/EntityCategory", "uint8 category\n"},
    {"simulation_interfaces/msg/TagsFilter", "string[] tags\nuint8 filter_mode\n"},
    {"simulation_interfaces/msg/EntityFilters", "string filter\nEntityCategory[] categories\nTagsFilter tags\nBounds bounds\n"},
    {"simulation_interfaces/msg/EntityInfo", "EntityCategory category\nstring description\nstring[] tags\n"},
    {"simulation_interfaces/msg/EntityState",
     "std_msgs/Header header\ngeometry_msgs/Pose pose\ngeometry_msgs/Twist twist\ngeometry_msgs/Accel acceleration\n"},
    {"simulation_interfaces/msg/Resource", "string uri\nstring resource_string\n"},
    {"simulation_interfaces/msg/Spawnable", "Resource entity_resource\nstring description\nBounds spawn_bounds\n"},
    {"simulation_interfaces/srv/GetSimulatorFeatures_Request", "uint8 structure_needs_at_least_one_member\n"},
    {"simulation_interfaces/srv/GetSimulatorFeatures_Response", "SimulatorFeatures features\n"},
    {"simulation_interfaces/srv/GetSimulationState_Request", "uint8 structure_needs_at_least_one_member\n"},
    {"simulation_interfaces/srv/GetSimulationState_Response", "SimulationState state\nResult result\n"},
    {"simulation_interfaces/srv/SetSimulationState_Request", "SimulationState state\n"},
    {"simulation_interfaces/srv/SetSimulationState_Response", "Result result\n"},
    {"simulation_interfaces/srv/ResetSimulation_Request", "uint8 scope\n"},
    {"simulation_interfaces/srv/ResetSimulation_Response", "Result result\n"},
    {"simulation_interfaces/srv/StepSimulation_Request", "uint64 steps\n"},
    {"simulation_interfaces/srv/StepSimulation_Response", "Result result\n"},
    {"simulation_interfaces/srv/GetEntities_Request", "EntityFilters filters\n"},
    {"simulation_interfaces/srv/GetEntities_Response", "Result result\nstring[] entities\n"},
    {"simulation_interfaces/srv/GetEntitiesStates_Request", "EntityFilters filters\n"},
    {"simulation_interfaces/srv/GetEntitiesStates_Response", "Result result\nstring[] entities\nEntityState[] states\n"},
    {"simulation_interfaces/srv/GetEntityState_Request", "string entity\n"},
    {"simulation_interfaces/srv/GetEntityState_Response", "Result result\nEntityState state\n"},
    {"simulation_interfaces/srv/SetEntityState_Request",
     "string entity\nEntityState state\nbool set_pose\nbool set_twist\nbool set_acceleration\n"},
    {"simulation_interfaces/srv/SetEntityState_Response", "Result result\n"},
    {"simulation_interfaces/srv/GetEntityInfo_Request", "string entity\n"},
    {"simulation_interfaces/srv/GetEntityInfo_Response", "Result result\nEntityInfo info\n"},
    {"simulation_interfaces/srv/GetSpawnables_Request", "string[] sources\n"},
    {"simulation_interfaces/srv/GetSpawnables_Response", "Result result\nSpawnable[] spawnables\n"},
    {"simulation_interfaces/srv/SpawnEntity_Request",
     "string name\nbool allow_renaming\nResource entity_resource\nstring entity_namespace\n"
     "geometry_msgs/PoseStamped initial_pose\n"},
    {"simulation_interfaces/srv/SpawnEntity_Response", "Result result\nstring entity_name\n"},
    {"simulation_interfaces/srv/DeleteEntity_Request", "string entity\n"},
    {"simulation_interfaces/srv/DeleteEntity_Response", "Result result\n"},
};

std::string package_of(const std::string& name) { return name.substr(0, name.find('/')); }

// "Point", "geometry_msgs/Point" of a definition in that package.
std::string whole_name(const std::string& type, const std::string& package) {
  if (kPrimitives.count(type)) return type;
  const std::size_t slash = type.find('/');
  return slash == std::string::npos ? package + "/msg/" + type : type.substr(0, slash) + "/msg/" + type.substr(slash + 1);
}

void add_line(std::string_view line, const std::string& package, Type& type) {
  const TextRow row = split_words(line, 1);
  if (row.words.size() != 2 || row.words[1].find('=') != std::string_view::npos) return;  // empty, or a constant
  std::string name(row.words[0]);
  const std::size_t bracket = name.find('[');
  const std::string array = bracket == std::string::npos ? "" : name.substr(bracket);
  type.fields.push_back({whole_name(name.substr(0, bracket), package), std::string(row.words[1]), array});
}

// A definition with those of the types in it, each after a line "MSG: package/Name".
void add_definition(std::string name, std::string_view text, Types& types) {
  Type type;
  const auto keep = [&] {
    if (!type.fields.empty()) types.emplace(name, std::move(type));
    type = {};
  };
  for (const std::string_view line : split_lines(text)) {
    if (line.rfind("MSG: ", 0) == 0) {
      keep();
      name = whole_name(std::string(line.substr(5)), "");
    } else {
      add_line(line, package_of(name), type);
    }
  }
  keep();
}

// "geometry_msgs::msg::dds_::Point_"
std::string idl_name(const std::string& type) {
  const std::size_t a = type.find('/'), b = type.rfind('/');
  return type.substr(0, a) + "::" + type.substr(a + 1, b - a - 1) + "::dds_::" + type.substr(b + 1) + "_";
}

void write_type(const std::string& name, Types& types, std::string& idl) {
  Type& type = types.at(name);
  if (type.written) return;
  type.written = true;
  for (const Field& field : type.fields)
    if (!kPrimitives.count(field.type)) write_type(field.type, types, idl);
  const std::size_t a = name.find('/'), b = name.rfind('/');
  const std::string kind = name.substr(a + 1, b - a - 1);
  idl += "module " + name.substr(0, a) + " { module " + kind + " { module dds_ {\n  @final struct " + name.substr(b + 1) + "_ {\n";
  if (kind == "srv") idl += "    unsigned long long client_number_;\n    long long request_number_;\n";
  for (const Field& field : type.fields) {
    const auto primitive = kPrimitives.find(field.type);
    const std::string of = primitive == kPrimitives.end() ? idl_name(field.type) : primitive->second;
    const bool list = field.array == "[]";
    idl += "    " + (list ? "sequence<" + of + ">" : of) + " " + field.name + (list ? "" : field.array) + ";\n";
  }
  idl += "  };\n}; }; };\n";
}

}  // namespace

std::string make_idl() {
  Types types;
  for (const MessageType* type :
       {&kImage, &kCompressedImage, &kCameraInfo, &kPoseStamped, &kTfMessage, &kClock, &kImu, &kEventArray, &kString, &kPointCloud,
        &kLaserScan, &kJointState, &kOdometry, &kWrenchStamped, &kRange, &kBool, &kFluidPressure, &kMagneticField, &kNavSatFix, &kLivoxScan,
        &kBatteryState})
    add_definition(type_name(*type, Version::ros2), type->definition2, types);
  for (const Definition& other : kOthers) add_definition(other.name, other.fields, types);
  std::string idl = "// Messages of Rubble over DDS, as ROS 2 names them. Made by `rubble info --idl`.\n";
  for (const auto& [name, type] : types) write_type(name, types, idl);
  return idl;
}

}  // namespace rubble::ros
