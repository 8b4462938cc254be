// The messages of Rubble in OMG's IDL, for programs that read DDS without ROS 2: `rubble info --idl`.
#pragma once

#include <string>

namespace rubble::ros {

// Every type that is published, heard, or part of a service, each after those that it uses, with the names that ROS 2 gives
// them in DDS. What a service is asked and answers begins with the client's number and the request's, as in
// rmw_cyclonedds.
std::string make_idl();

}  // namespace rubble::ros
