/// A plugin of the first version of the border between program and plugins.

extern "C" {
struct Description {
  int abi;
  const char* build_id;
  const char* name;
  void (*register_planners)(void* registry);
};
Description routebench_plugin() { return {1, "compiled long ago", "old", nullptr}; }
}
