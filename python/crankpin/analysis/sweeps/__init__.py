"""Balances of many engines, speeds, bank angles and rod ratios in one call."""
