"""Restoring forces of the stepwise flow: contacts of closed form, tables of samples, functions of the user's."""
