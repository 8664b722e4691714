"""Contact laws at a point."""

import os
import pathlib
import unittest

from scipy.integrate import trapezoid

import pyroclast
from pyroclast import MPa
from small import Case

COHESIVE = {"K_n": "18400 GPa/m", "K_s": "7660 GPa/m", "f_t": 2.5 * MPa, "G_f1": "60 N/m", "f_cm": "31 MPa",
            "beta": 0.05, "c_o": "3.8 MPa", "c_res": "0.038 MPa", "phi": "34 deg", "phi_res": "34 deg",
            "G_f2": "240 N/m"}


class Laws(Case):
    def cohesive(self, **more):
        known = pyroclast.Law.properties_of("cohesive")
        return pyroclast.Law("cohesive", **{key: value for key, value in {**COHESIVE, **more}.items() if key in known})

    def test_tearing_a_point_apart_takes_its_fracture_energy(self):
        answer = self.cohesive().drive([0.0, 2e-4], steps=2000)
        self.assertAlmostEqual(trapezoid(answer["sigma_Pa"], answer["u_n_m"]), 60.0, delta=0.1)
        self.assertAlmostEqual(answer["sigma_Pa"].max(), 2.5e6, delta=2e4)
        self.assertEqual(len(answer["u_n_m"]), 2 * 2000)

    def test_what_is_wrong_is_said(self):
        with self.assertRaisesRegex(pyroclast.Error, "f_t"):
            self.cohesive(f_t="2.5 mm")
        with self.assertRaisesRegex(pyroclast.Error, "needs"):
            pyroclast.Law("cohesive")
        with self.assertRaisesRegex(pyroclast.Error, "nosuch"):
            pyroclast.Law("nosuch")
        with self.assertRaisesRegex(pyroclast.Error, "at least one step"):
            self.cohesive().drive([1e-6], steps=0)


@unittest.skipIf(os.environ.get("PYROCLAST_NO_COMPILE"), "no compiler is wanted")
class OwnLaws(Case):
    def test_a_header_that_is_no_law_is_refused_with_its_name(self):
        header = self.folder() / "none.hpp"
        header.write_text("struct Nothing {};\n")
        with self.assertRaisesRegex(pyroclast.Error, "none.hpp"):
            pyroclast.Law(header)
