kerf_add_test(height_mesh_test
  SOURCES height_mesh_test.cpp
  LINK kerf_height_mesh)
