/// The tests' toy planners as a plugin, so that the built program can be seen to run them.

#include "../toy_planners.hpp"
#include "routebench/planning/plugin.hpp"

ROUTEBENCH_REGISTER(toys) {
  registry.add<routebench::test::OnceRound>();
  registry.add<routebench::test::Leash>();
  registry.add<routebench::test::SeedTeller>();
  registry.add<routebench::test::Wrongdoer>();
}
