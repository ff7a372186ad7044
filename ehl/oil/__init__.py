"""The lubricant: viscosity and density under pressure and temperature, grades, measured tables."""
