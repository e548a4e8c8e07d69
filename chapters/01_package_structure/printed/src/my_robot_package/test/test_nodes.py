import unittest

from my_robot_package.utils.data_processing import calculate_average


class TestAverage(unittest.TestCase):
    def test_average(self):
        self.assertEqual(calculate_average([1.0, 3.0]), 2.0)
