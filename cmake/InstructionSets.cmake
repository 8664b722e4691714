# The instruction sets that the step and the rows of contact laws are compiled for, the type of each in
# base/lanes.hpp, and its flags. Also part of the package, for laws that are built outside of this project.
# Tuned for generic processors GCC 12 clears lanes with slow string instructions; of its header for AVX-512 it warns.
set(pyroclast_instruction_sets portable)
set(pyroclast_type_of_portable Portable)
set(pyroclast_flags_of_portable)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  list(APPEND pyroclast_instruction_sets avx2 avx512)
  # Here it serves old processors and tests alone; more would take minutes to compile (mixed_mode: 58 s for 161 s).
  set(pyroclast_flags_of_portable -O1)
  set(pyroclast_type_of_avx2 Avx2)
  set(pyroclast_flags_of_avx2 -mavx2 -mtune=znver3)
  set(pyroclast_type_of_avx512 Avx512)
  set(pyroclast_quiet_avx512_header)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    set(pyroclast_quiet_avx512_header -Wno-uninitialized -Wno-maybe-uninitialized)
  endif()
  set(pyroclast_flags_of_avx512 -mavx512f -mavx512dq -mavx512vl -mtune=znver3 ${pyroclast_quiet_avx512_header})
endif()
# Arithmetic as IEEE 754 has it: contracting a*b+c into one instruction differently in two inlined copies of a loop
# would make the result depend on the optimizer; results are promised bitwise, so it is off.
set(pyroclast_arithmetic_flags -ffp-contract=off -fno-math-errno)
# Of a law outside of this project, whatever the build type and flags of that project.
set(pyroclast_law_flags -O3 ${pyroclast_arithmetic_flags} -fno-fast-math -fvisibility=hidden -fvisibility-inlines-hidden)
