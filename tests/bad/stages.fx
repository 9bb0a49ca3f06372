// In a file.
ColorOp[0] = Modulate;
ColorArg1[0] = Textur;
AlphaOp[0] = DotProduct3;
