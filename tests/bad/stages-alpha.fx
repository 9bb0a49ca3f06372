ColorOp[0] = Modulate;
AlphaOp[0] = DotProduct3;
