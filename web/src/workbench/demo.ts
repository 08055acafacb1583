// The workbench without a server: one file with the program in it.

import { Inside, compiled } from "./inside.ts";
import { Workbench } from "./workbench.ts";

const text = document.getElementById("program")?.textContent?.trim() ?? "";
void compiled(text).then((code) => new Workbench(new Inside(code)).start());
