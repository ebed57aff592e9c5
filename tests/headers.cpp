// Carries the headers that tests share; see cmake/testing.cmake.
