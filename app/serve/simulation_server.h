// Serves a world: topics of its robots go out, commands come in, and the services of simulation_interfaces are answered
// (docs/how_to/live.md).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/serve/served_world.h"
#include "io/live/complaints.h"
#include "io/live/simulation_services.h"
#include "io/recording/recorder.h"

namespace rubble {

class LiveServer;

class SimulationServer {
 public:
  // paused: until a client lets it play. The world and the server must outlive this.
  SimulationServer(ServedWorld& world, LiveServer& server, bool paused, const std::function<void(const std::string&)>& notice);
  ~SimulationServer();

  // Until a client lets it quit, a signal comes, or so much was simulated; 0: no end. unit: s
  void run(double duration);

 private:
  using Result = simulation_services::Result;
  using Request = simulation_services::Request;
  using State = simulation_services::State;
  // Reads the request, and writes what follows its numbers. Throws RunError before anything is done: it is no such request.
  using Answer = void (SimulationServer::*)(WireCursor& body, ros::Wire& reply);
  struct Service {
    const char *name, *type;
    Answer answer;
    void (*rest)(ros::Wire& reply);  // writes what follows the result where nothing was done
  };
  static const std::vector<Service>& services();

  void answer_all();
  void answer(std::size_t service, const std::string& bytes);
  void hear();
  void step();
  // After a restart: what is published goes on from there.
  void begin();

  void get_features(WireCursor& body, ros::Wire& reply);
  void get_state(WireCursor& body, ros::Wire& reply);
  void set_state(WireCursor& body, ros::Wire& reply);
  void reset(WireCursor& body, ros::Wire& reply);
  void step_simulation(WireCursor& body, ros::Wire& reply);
  void get_entities(WireCursor& body, ros::Wire& reply);
  void get_entities_states(WireCursor& body, ros::Wire& reply);
  void get_entity_state(WireCursor& body, ros::Wire& reply);
  void set_entity_state(WireCursor& body, ros::Wire& reply);
  void get_entity_info(WireCursor& body, ros::Wire& reply);
  void get_spawnables(WireCursor& body, ros::Wire& reply);
  void spawn(WireCursor& body, ros::Wire& reply);
  void remove(WireCursor& body, ros::Wire& reply);

  Result change_state(State target);
  Result try_spawn(const simulation_services::SpawnRequest& request, std::string& name);
  Result select(const simulation_services::Filters& filters, std::vector<const Entity*>& selected) const;
  simulation_services::EntityState state_of(const Entity& entity) const;

  ServedWorld& world_;
  LiveServer& server_;
  Complaints complaints_;
  State state_;
  bool stepping_ = false;  // for a client; others may end it
  std::vector<std::uint32_t> numbers_;            // of the services
  std::map<std::string, std::uint32_t> topics_;   // that go out
  std::map<std::string, std::uint32_t> heard_;    // that come in
  std::map<std::string, double> twists_until_;    // by robot: the time until which its last twist holds; unit: s
  std::unique_ptr<Recorder> recorder_;
};

}  // namespace rubble
